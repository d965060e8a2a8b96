// One particle: system file, world, a loop until t = 5.
#include <carom/carom.hpp>
#include <cstdio>

int main(int argc, char** argv) {
  // A built-in name or a TOML file.
  const carom::System system = carom::load_system(argc > 1 ? argv[1] : "mushroom").system;

  carom::World world = carom::make_world(system);
  const int particle =
      world.add(system.particles[0], carom::draw_initial_state(system, world, 0, 0));

  for (double t = 0; t <= 5 && !world.finished(particle); t += 0.5) {
    world.run_until(t);
    const carom::State state = world.state_at(particle, t);
    std::printf("t = %.1f  x = %+.15f  y = %+.15f\n", t, state.position.x, state.position.y);
  }
  std::printf("%s after %d hits\n", carom::name_of(world.fate(particle)),
              int(world.hits(particle)));
}
