# Survival in a magnetic square: exponential first, then a plateau of islands and a slow tail.
import carom

result = carom.escape("magnetic-square", trajectories=200_000)
result.plot()[0].figure.savefig("magnetic_square.png")
