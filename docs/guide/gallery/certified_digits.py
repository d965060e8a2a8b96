# Bits that a certified orbit of the stadium loses: about the same number at each hit.
import matplotlib.pyplot as pyplot

import carom

pyplot.style.use(carom.plot.STYLE)
table = carom.stadium(half_length=1, radius=1)
start = {"position": ("1/10", "1/5"), "velocity": ("3/5", "4/5"), "precision": "certified"}
counts = [10, 20, 50, 100, 200, 500]
lost = [carom.run(table, collisions=n, **start).lost_bits for n in counts]
figure, ax = pyplot.subplots(figsize=(5, 3.5), layout="constrained")
ax.plot(counts, lost, "o-")
ax.axhline(53, color="0.5", linestyle=":", label="bits of a double")
ax.set(xlabel="hits", ylabel="bits lost", xlim=(0, None), ylim=(0, None))
ax.legend()
figure.savefig("certified_digits.png", dpi=100)
