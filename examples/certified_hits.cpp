// Hits with guaranteed digits: an iterator, and the end of an orbit that leaves through a hole.
#include <carom/carom.hpp>
#include <cstdio>

int main() {
  carom::SystemOverrides start;
  start.position = "1/10,1/5";  // as written: no double is near
  start.velocity = "sqrt(3),1";
  const carom::LoadedSystem stadium = carom::load_system("stadium", start);

  std::uint64_t hits = 0;
  for (const carom::CertifiedHit& hit : carom::certified_orbit(stadium.exact, 100, 30)) {
    hits = hit.number;
    if (hits % 20 != 0) continue;
    const char* wall = stadium.system.table->walls[static_cast<std::size_t>(hit.wall)].name.c_str();
    std::printf("%3d  %-6s x = %s\n", int(hits), wall, hit.x.text(30).c_str());
  }

  carom::CertifiedTask task;
  task.t_max = carom::ExactNumber("10000", {});
  task.digits = 40;
  carom::CertifiedOrbit orbit(stadium.exact, task);
  const carom::CertifiedEnd& end = orbit.finish();
  std::printf("%s after %d collisions at t = %s, by %ld bits\n", carom::name_of(end.fate), int(end.collisions),
              end.t.text(task.digits).c_str(), orbit.effort().bits);
  return end.fate == carom::CertifiedFate::escaped && end.collisions >= hits ? 0 : 1;
}
