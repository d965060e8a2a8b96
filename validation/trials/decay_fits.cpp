// Fits the decays of ensembles whose escapes are counted already, for decay_laws.py: one line of
// standard input an ensemble, one line of standard output a fit.
//
// In:  PARTICLES THERE UNTIL FROM TO TIME COUNT TIME COUNT …
//      THERE of the PARTICLES are still there at UNTIL; a window, or 0 0; COUNT escape at TIME.
// Out: decided or undecided, local or lasting, FROM, TO, then of each law, the likeliest first:
//      its name, rate and error, amplitude and error, plateau and error, p-value; separated by
//      tabs. "none" and why where nothing was fitted.
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>

#include "carom/analyses/escape/decay.hpp"

int main() {
  std::ios::sync_with_stdio(false);
  std::cout << std::setprecision(17);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream in(line);
    std::uint64_t particles = 0, there = 0, count = 0;
    double until = 0.0, time = 0.0;
    carom::DecayWindow window;
    in >> particles >> there >> until >> window.first >> window.second;
    carom::EscapeTimes times;
    while (in >> time >> count) times.add(time, count);
    const carom::DecayFit fit = window.second > 0.0
                                    ? carom::fit_decay(times, particles, there, until, window)
                                    : carom::fit_decay(times, particles, there, until);
    if (fit.decays.empty()) {
      std::cout << "none\t" << fit.why_none << '\n';
      continue;
    }
    std::cout << (fit.decided ? "decided" : "undecided") << '\t'
              << (fit.decays[0].local ? "local" : "lasting") << '\t' << fit.from << '\t' << fit.to;
    for (const carom::Decay& decay : fit.decays)
      std::cout << '\t' << carom::name_of(decay) << '\t' << decay.rate << '\t' << decay.rate_error
                << '\t' << decay.amplitude << '\t' << decay.amplitude_error << '\t' << decay.plateau
                << '\t' << decay.plateau_error << '\t' << decay.p_value;
    std::cout << '\n';
  }
}
