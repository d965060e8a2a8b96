#include "lanes/free/lane_tangents.hpp"

#include <cmath>

namespace carom::lanes {

void LaneTangents::follow(std::vector<double> times, double unit_length,
                          Lanes::Stretched stretched) {
  times_ = std::move(times);
  unit_length_ = unit_length;
  stretched_ = std::move(stretched);
  walls_ = motion::tangent_walls(table_.walls, table_.lattice);
  forms_.pieces = pieces_.pieces;
  for (int piece = 0; piece < pieces_.pieces; ++piece) {
    if (pieces_.wall[piece] < 0.0) continue;  // a copy
    const WallForm<double>& form = walls_.walls[static_cast<std::size_t>(pieces_.wall[piece])];
    forms_.center_x[piece] = form.center_x;
    forms_.center_y[piece] = form.center_y;
    forms_.xx[piece] = form.xx;
    forms_.xy[piece] = form.xy;
    forms_.yy[piece] = form.yy;
    forms_.determinant[piece] = form.determinant;
    forms_.normal_x[piece] = form.normal_x;
    forms_.normal_y[piece] = form.normal_y;
  }
  if (!walls_.lattice) return;
  forms_.lattice_x[0] = walls_.lattice->first.x, forms_.lattice_x[1] = walls_.lattice->second.x;
  forms_.lattice_y[0] = walls_.lattice->first.y, forms_.lattice_y[1] = walls_.lattice->second.y;
}

double LaneTangents::next_mark(const LaneTrajectory& mine) const {
  return mine.marked < times_.size() ? times_[mine.marked] : HUGE_VAL;
}

void LaneTangents::begin(LaneTrajectory& mine) const {
  mine.tangent.begin(mine.start.state, mine.start.particle, unit_length_);
  mine.marked = 0;
}

void LaneTangents::put(FilledPack& lanes, int lane) const {
  TangentPack& to = lanes.tangents;
  const LaneTrajectory& mine = lanes.trajectory(lane);
  const motion::FreeTangent& t = mine.tangent;
  for (int k = 0; k < 2; ++k) {
    to.place[k][lane] = t.deviation[k].place;
    to.rate[k][lane] = t.deviation[k].rate;
    to.shrunk[k][lane] = t.shrunk[k];
  }
  to.hits[lane] = static_cast<double>(mine.start.hits);
  to.high[lane] = t.last.time.high;
  to.low[lane] = t.last.time.low;
  to.x[lane] = t.last.position.x;
  to.y[lane] = t.last.position.y;
  to.vx[lane] = t.last.velocity.x;
  to.vy[lane] = t.last.velocity.y;
  to.first[lane] = static_cast<double>(t.last.cell.first);
  to.second[lane] = static_cast<double>(t.last.cell.second);
  to.square[lane] = t.square;
  to.inverse_square[lane] = 1.0 / t.square;
  to.omega[lane] = t.omega;
  to.unit[lane] = t.unit;
  to.mark[lane] = next_mark(mine);
}

void LaneTangents::take(FilledPack& lanes, int lane) const {
  const TangentPack& from = lanes.tangents;
  motion::FreeTangent& t = lanes.trajectory(lane).tangent;
  for (int k = 0; k < 2; ++k) {
    t.deviation[k] = {from.place[k][lane], from.rate[k][lane]};
    t.shrunk[k] = from.shrunk[k][lane];
  }
  t.last.time = {from.high[lane], from.low[lane]};
  t.last.position = {from.x[lane], from.y[lane]};
  t.last.velocity = {from.vx[lane], from.vy[lane]};
  t.last.cell = {static_cast<std::int64_t>(from.first[lane]),
                 static_cast<std::int64_t>(from.second[lane])};
}

void LaneTangents::sweep(FilledPack& lanes) {
  for (unsigned long long due = kernels_.due(lanes.pack, lanes.tangents); due != 0;
       due &= due - 1) {
    const int lane = __builtin_ctzll(due);
    LaneTrajectory& mine = lanes.trajectory(lane);
    take(lanes, lane);
    const std::uint64_t hits =
        std::exchange(mine.start.hits, static_cast<std::uint64_t>(lanes.tangents.hits[lane]));
    tell(mine, {lanes.pack.high[lane], lanes.pack.low[lane]}, false);
    mine.start.hits = hits;
    lanes.tangents.mark[lane] = next_mark(mine);
  }
  kernels_.carry(forms_, lanes.pack, lanes.tangents);
}

void LaneTangents::hit(LaneTrajectory& mine, const State& state) const {
  tell(mine, state.time, false);
  mine.tangent.hit(walls_, state);
}

void LaneTangents::tell(LaneTrajectory& mine, const Time& time, bool also_at) const {
  for (; mine.marked < times_.size(); ++mine.marked) {
    const Time mark(times_[mine.marked]);
    if (also_at ? mark > time : !(mark < time)) return;
    stretched_(mine.start.tag, mine.marked, mine.tangent.logarithms(times_[mine.marked]),
               mine.start.hits);
  }
}

}  // namespace carom::lanes
