# How long a particle stays that starts on the bottom of the mushroom's stem, by place and direction.
import carom

grid = {"kind": "birkhoff", "wall": "stem_bottom",
        "s": {"from": 0.005, "to": 0.995, "count": 200},
        "v_parallel": {"from": -0.99, "to": 0.99, "count": 200}}  # fmt: skip
table = carom.mushroom(1, 1, 1).hole("cap", center="pi/2", width=0.5).with_(initial=grid, t_max=100)
result = carom.escape(table, trajectories=40_000, per_trajectory=True)
ax = carom.plot.basins(result, x="x", y="vx", colour="time")
ax.figure.savefig("mushroom_basins.png")
