# Diffusion coefficient of a Lorentz gas against the magnetic field: it has a dip near B = 0.25.
import matplotlib.pyplot as pyplot

import carom

pyplot.style.use(carom.plot.STYLE)
gas = carom.lorentz(spacing=2.2, radius=1)
result = carom.diffusion(gas, sweep={"field.B": "lin:0:1.5:25"}, trajectories=5000, t_max=100)
figure, ax = pyplot.subplots(figsize=(5, 3.5), layout="constrained")
result.plot(ax)
ax.set(ylim=(0, None), title="")
figure.savefig("sweep.png", dpi=100)
