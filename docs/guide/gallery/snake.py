# A snake orbit along the edge (dashed) between two opposite magnetic fields.
import carom

strip = carom.rectangle(12, 3).obstacle("polygon", name="below", points=[(0.1, 0.1), (11.9, 0.1), (11.9, 1.5), (0.1, 1.5)])
strip = strip.region("below_side_1", B=-2).with_(B=2, title="Fields of 2 above and -2 below")
run = carom.run(strip, position=(0.2, 1.6), velocity=(0.6, 0.8), t_max=15)
run.plot().figure.savefig("snake.png")
