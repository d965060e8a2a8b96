// Listening to hits: the mean flight between them against pi A / L.
#include <carom/carom.hpp>
#include <cmath>
#include <cstdio>

struct Flights : carom::Observer {
  double sum = 0;
  double count = 0;
  void hit(const carom::HitEvent& event) override {
    sum += event.flight_time;
    ++count;
  }
};

int main() {
  carom::SystemOverrides changes;
  changes.set = {{"initial.kind", "boundary"}};  // cosine law from all walls
  changes.collisions = "200";
  const carom::System system = carom::load_system("sinai", changes).system;

  carom::World world(*system.table);
  world.limit_hits(system.run.collisions);
  Flights flights;
  for (std::uint64_t trajectory = 0; trajectory < 500; ++trajectory) {
    world.clear();
    world.add(system.particles[0], carom::draw_initial_state(system, world, trajectory, 0));
    world.run_until(1e9, flights);
  }
  const double mean = flights.sum / flights.count, expected = carom::measure(*system.table).mean_flight;
  std::printf("mean flight %.5f, pi A / L = %.5f\n", mean, expected);
  return std::abs(mean / expected - 1) < 0.02 ? 0 : 1;
}
