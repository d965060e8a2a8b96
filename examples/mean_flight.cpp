// An observer of your own: the mean flight between hits against pi A / L.
#include <carom/carom.hpp>
#include <cstdio>
struct Flights : carom::Observer {
  double sum = 0, count = 0;
  void hit(const carom::HitEvent& event) override { sum += event.flight_time, ++count; }
};
int main() {
  const auto system = carom::make_system(carom::sinai(1, 0.4), {.t_max = 1000});
  Flights flights;
  carom::for_each_trajectory(system, {0, 100}, flights);
  const double mean = flights.sum / flights.count,
               expected = carom::measure(*system.table).mean_flight;
  std::printf("mean flight %.5f, pi A / L = %.5f\n", mean, expected);
  return mean / expected > 0.98 && mean / expected < 1.02 ? 0 : 1;
}
