# Energies of charges in a harmonic well: their sum is conserved.
import carom

run = carom.run("wigner", t_max=10, sample=0.02)
carom.plot.energy(run).figure.savefig("wigner_energy.png")
