# The same for starts on a line in all directions.
import numpy

import carom

grid = [[x, 2, c, (1 - c * c) ** 0.5]
        for x in numpy.linspace(2, 4, 200) for c in numpy.linspace(-0.5, 0.5, 200)]  # fmt: skip
system = carom.system("three-disc").with_(initial={"kind": "list", "starts": grid})
result = carom.escape(system, trajectories=len(grid), per_trajectory=True)
carom.plot.basins(result, x="x", y="vx", colour="hits").figure.savefig("three_discs_basins.png")
