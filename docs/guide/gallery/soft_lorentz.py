# Displacements in a lattice of soft bumps, with one orbit.
import carom

ax = carom.diffusion("soft-lorentz", trajectories=2000, t_max=100).plot()
inset = ax.inset_axes([0.58, 0.06, 0.4, 0.4], xticks=[], yticks=[])
carom.run("soft-lorentz", t_max=15, sample=0.02).plot(ax=inset).set(title="", xlabel="", ylabel="")
ax.figure.savefig("soft_lorentz.png")
