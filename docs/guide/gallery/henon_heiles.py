# The section of Hénon and Heiles at energy 1/8.
import carom

starts = {"kind": "rectangle", "min": [-0.3, -0.4], "max": [0.3, 0.5]}
system = carom.system("henon-heiles").with_(initial=starts)
section = carom.section(system, on="x=0", direction="positive", orbits=40, points=200, t_max=2000)
section.plot().figure.savefig("henon_heiles.png")
