# Diffusion in a Lorentz gas against the magnetic field, with errors.
import matplotlib.pyplot as pyplot

import carom

gas = carom.lorentz(spacing=2.2, radius=1)
fields = [0, 0.25, 0.5, 0.75, 1, 1.25, 1.5]
results = [carom.diffusion(gas, B=B, trajectories=5000, t_max=100).D for B in fields]
figure, ax = pyplot.subplots(figsize=(5, 3.5), layout="constrained")
ax.errorbar(fields, [D.value for D in results], yerr=[D.stderr for D in results], fmt="o-")
ax.set(xlabel="B", ylabel="D", ylim=(0, None))
figure.savefig("sweep.png", dpi=100)
