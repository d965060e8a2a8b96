# A snake orbit along the edge (dashed) between two opposite magnetic fields.
import carom

strip = carom.polygon([(0, 0), (12, 0), (12, 1.5), (12, 3), (0, 3), (0, 1.5)])
strip = strip.region(start=(12, 1.5), pieces=[{"line_to": (0, 1.5)}], B=-2)
strip = strip.with_(B=2, title="Fields of 2 above and -2 below")
run = carom.run(strip, position=(0.2, 1.6), velocity=(0.6, 0.8), t_max=15)
run.plot().figure.savefig("snake.png")
