# Eight hard discs in a box.
import carom

box = carom.rectangle(4, 3).with_(
    particles={"count": 8}, interaction={"kind": "hard-discs", "radius": 0.3}
)
run = carom.run(box, t_max=4)
run.plot().figure.savefig("hard_discs.png")
