# Escape rate of a magnetic square: exponential first, then a slow tail beside islands.
import carom

result = carom.escape("magnetic-square", trajectories=1_000_000)
carom.plot.rate(result).figure.savefig("magnetic_square.png")
