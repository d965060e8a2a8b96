#include "lanes/free/lane_start.hpp"

#include <algorithm>
#include <cmath>

#include "lanes/free/make_lane_table.hpp"
#include "motion/free_motion.hpp"

namespace carom::lanes {

using geometry::Vector;

namespace {

// | |c|^2 - v^2 | of a joint errs by 2^-45 g^2, g >= s + |omega| S ...
constexpr double circle_margin = 0x1p-40;
// ... and is |omega| d (|c| + s) <= |omega| d 2g at the distance d from the circle: beyond twice
// the margin of a side, times |omega| S g, d is beyond that of a side.
constexpr double near_margin = 2.0 * side_margin;

/// In the open plane flights may start beyond all lengths that margins are measured by.
bool within(const LaneTable& t, Vector p) {
  return std::fabs(p.x) <= 0.5 * t.size && std::fabs(p.y) <= 0.5 * t.size;
}

/// On a lattice flights start in the cell about the origin.
bool in_cell(const LaneTable& t, Vector p) {
  for (int i = 0; i < t.edges; ++i) {
    const int next = i + 1 == t.edges ? 0 : i + 1;
    const Vector from{t.edge_x[i], t.edge_y[i]},
        along = Vector{t.edge_x[next], t.edge_y[next]} - from;
    if (!(cross(along, p - from) > side_margin * t.size * t.size)) return false;
  }
  return true;
}

/// What margins are made of: the particle's speed and, on Larmor circles, its turn. The lane's last
/// particle has often left the same behind.
void put_particle(LanePack& pack, int lane, const LaneTable& t, const Particle& p) {
  if (pack.speed[lane] == p.speed && pack.omega[lane] == p.omega) return;
  pack.speed[lane] = p.speed;
  pack.directions[lane] = t.directions_per_unit / p.speed;
  pack.offsets[lane] = t.offsets_per_length / p.speed;
  pack.cut[lane] = t.cut_within * p.speed;
  pack.cut_far[lane] = t.cut_within_far * p.speed;
  pack.passed[lane] = t.passed_beyond * p.speed;
  pack.square_speed[lane] = p.speed * p.speed;
  const geometry::EnergyShell<double> shell = motion::energy_shell(p.speed);
  pack.shell_weight[lane] = shell.weight;
  pack.shell_rest[lane] = shell.rest;
  pack.sides[lane] = side_margin * t.size * p.speed;
  pack.order[lane] = t.order_margin * t.size / p.speed;
  pack.shortest[lane] = 2.0 * pack.sides[lane] / pack.square_speed[lane];
  pack.roots[lane] = pack.sides[lane] * t.size * p.speed;
  pack.omega[lane] = p.omega;
  if (turn_of(p.omega) == Turn::straight) return;
  const double turned = std::fabs(p.omega) * t.size, pace = p.speed + turned;
  pack.inverse_half[lane] = 1.0 / (0.5 * std::fabs(p.omega));
  // Where the table has no size to measure by, no lane decides anything.
  pack.pace[lane] = std::isfinite(pace) ? std::ldexp(1.0, std::ilogb(pace) + 1) : HUGE_VAL;
  pack.joint_margin[lane] = std::max(near_margin * turned, circle_margin * pace) * pace;
}

}  // namespace

bool can_start(const LaneTable& t, const events::PieceTable& walls, LaneStart& start) {
  State& s = start.state;
  if (s.wall < 0) return within(t, s.position) && in_cell(t, s.position);
  const geometry::PreparedCurve& w = walls.curve(s.wall);
  if (!(s.u > geometry::first_parameter && s.u < w.last())) return false;
  const auto frame = w.frame(s.u);
  if (w.parameter(s.position) != s.u) s.position = frame.point;
  const int piece = piece_at(t, s.wall, s.u);
  return (t.bent[piece] ? 1.0 : t.size) * dot(frame.normal, s.velocity) >
         t.ellipses.inward[piece] * start.particle.speed;
}

void put_into(LanePack& pack, int lane, const LaneTable& t, const LaneStart& start) {
  const State& s = start.state;
  pack.x[lane] = s.position.x;
  pack.y[lane] = s.position.y;
  pack.vx[lane] = s.velocity.x;
  pack.vy[lane] = s.velocity.y;
  pack.high[lane] = s.time.high;
  pack.low[lane] = s.time.low;
  pack.piece[lane] = s.wall < 0 ? -1.0 : piece_at(t, s.wall, s.u);
  pack.born[lane] = pack.sweep - static_cast<double>(start.hits);
  pack.next_cap = std::min(pack.next_cap, pack.born[lane] + pack.limit);
  pack.home_first[lane] = static_cast<double>(s.cell.first);
  pack.home_second[lane] = static_cast<double>(s.cell.second);
  pack.cell_first[lane] = pack.cell_second[lane] = 0.0;
  // A particle that begins off the discs searches its first one; its entry of the table is not
  // looked at.
  pack.aside_home[lane] =
      s.wall < 0 ? HUGE_VAL : cross(s.velocity, Vector{t.point_x[0], t.point_y[0]} - s.position);
  look_again(pack, lane);
  pack.cells[2 * lane] = pack.cells[2 * lane + 1] = 0;
  const unsigned long long bit = 1ULL << lane;
  pack.searching = s.wall < 0 ? pack.searching | bit : pack.searching & ~bit;
  put_particle(pack, lane, t, start.particle);
}

void move_into(LanePack& pack, int lane, const LaneTable& t, const Particle& particle,
               const LanePack& from, int other) {
  pack.x[lane] = from.x[other];
  pack.y[lane] = from.y[other];
  pack.vx[lane] = from.vx[other];
  pack.vy[lane] = from.vy[other];
  pack.high[lane] = from.high[other];
  pack.low[lane] = from.low[other];
  pack.piece[lane] = from.piece[other];
  pack.born[lane] = pack.sweep - from.hits(other);
  pack.next_cap = std::min(pack.next_cap, pack.born[lane] + pack.limit);
  pack.home_first[lane] = pack.home_second[lane] = 0.0;
  pack.cell_first[lane] = pack.cell_second[lane] = 0.0;
  pack.cells[2 * lane] = pack.cells[2 * lane + 1] = 0;
  pack.searching &= ~(1ULL << lane);
  put_particle(pack, lane, t, particle);
}

}  // namespace carom::lanes
