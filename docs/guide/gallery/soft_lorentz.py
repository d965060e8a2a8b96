# Displacements in a lattice of soft bumps.
import carom

result = carom.diffusion("soft-lorentz", trajectories=2000, t_max=100)
result.plot().figure.savefig("soft_lorentz.png")
