# Number of hits before a particle escapes from three discs, for starts on a line: a fractal.
import matplotlib.pyplot as pyplot

import carom

pyplot.style.use(carom.plot.STYLE)
system = carom.system("three-disc").with_(
    initial={"kind": "line", "from": [2.2, 2], "to": [3.8, 2], "angle": "pi/2"}
)
rows = carom.escape(system, trajectories=50_000, per_trajectory=True).per_trajectory
figure, ax = pyplot.subplots(figsize=(6, 3), layout="constrained")
ax.plot(rows["x"], rows["hits"], ".", markersize=1.5)
ax.set(xlabel="x of the start", ylabel="hits before escape")
figure.savefig("three_discs.png", dpi=100)
