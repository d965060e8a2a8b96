# Diffusion in the triangular Lorentz gas.
import carom

result = carom.diffusion("lorentz-triangular", trajectories=20_000)
result.plot().figure.savefig("lorentz_diffusion.png")
