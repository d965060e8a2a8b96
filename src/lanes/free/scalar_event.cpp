#include "lanes/free/scalar_event.hpp"

#include <utility>

#include "lanes/free/exit_by_signs.hpp"
#include "lanes/free/make_lane_table.hpp"

namespace carom::lanes {

ScalarEvent::ScalarEvent(World world, LaneTable& pieces, Turn turn)
    : world_(std::move(world)), pieces_(pieces), turn_(turn) {}

void ScalarEvent::fly(const LaneStart& start, std::vector<double> times, std::uint64_t limit,
                      double t_end, const std::function<bool()>& stopped) {
  entry_ = entry_at(start);
  hits_before_ = start.hits;
  seen_.time = start.state.time;
  seen_.states.clear();
  world_.sample_at(std::move(times));
  world_.clear();
  world_.limit_hits(limit);
  world_.add(start.particle, start.state, start.hits);
  world_.run_until(t_end, seen_, stopped);
}

/// Where the exit of a flight is decided by the sides of joints: the entry for it.
int ScalarEvent::entry_at(const LaneStart& start) const {
  const State& s = start.state;
  if (!pieces_.by_signs || turn_ != Turn::straight || s.wall < 0) return -1;
  // The world flies from u where the position is another one.
  const geometry::PreparedCurve& w = walls().curve(s.wall);
  if (!(s.u > geometry::first_parameter && s.u < w.last() && w.parameter(s.position) == s.u))
    return -1;
  const int piece = piece_at(pieces_, s.wall, s.u);
  return piece < 0 ? -1
                   : entry_of(pieces_, piece, s.position, s.velocity,
                              side_margin * pieces_.size * start.particle.speed);
}

void ScalarEvent::learn() {
  if (entry_ < 0) return;
  int piece = -1;
  const State after = state();
  if (fate() == Fate::escaped)
    for (int i = 0; i < pieces_.pieces; ++i)
      piece = static_cast<int>(pieces_.hole[i]) == hole() ? i : piece;
  else if (hits() == hits_before_ + 1 && after.u > geometry::first_parameter)
    piece = piece_at(pieces_, after.wall, after.u);
  if (piece >= 0) pieces_.exit[entry_] = static_cast<unsigned char>(piece);
}

}  // namespace carom::lanes
