# Light from the cusp of a cardioid, reflected once: its envelope is a nephroid.
import matplotlib.pyplot as pyplot
import numpy

import carom

pyplot.style.use(carom.plot.STYLE)
cardioid = carom.cardioid()
angles = numpy.linspace(-1.55, 1.55, 121)
cusp = {"kind": "birkhoff", "wall": "curve_1", "s": [1e-6] * 121, "v_parallel": [*numpy.sin(angles)]}
ax = cardioid.plot()
for rows in carom.hits(cardioid, initial=cusp, trajectories=len(angles), t_max=6):
    for k in range(len(angles)):
        x, y = (rows[name][rows["trajectory"] == k][:2] for name in "xy")
        ax.plot(x, y, x, -y, color="C0", lw=0.6, alpha=0.5)
ax.figure.savefig("cardioid.png")
