# An electron among antidots in a magnetic field, coloured by time.
import carom

run = carom.run("antidot-magnetic", t_max=60, sample=0.02)
run.plot(by="time").figure.savefig("antidots.png")
