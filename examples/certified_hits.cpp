// Hits with guaranteed digits, from a start that no double is.
#include <carom/carom.hpp>
#include <cstdio>
using namespace carom::literals;

int main() {
  const auto stadium = carom::stadium(2, 1);
  const carom::ExactStart start{.position = {"1/10"_exact, "1/5"_exact},
                                .direction = {1, "1/3"_exact}};
  int hits = 0;
  for (const carom::CertifiedHit& hit : carom::certified_orbit(stadium, start, 200, 30)) {
    std::printf("%-6s x = %s\n", stadium.table->wall(hit.wall).name.c_str(),
                hit.x.text(30).c_str());
    ++hits;
  }
  return hits == 200 ? 0 : 1;
}
