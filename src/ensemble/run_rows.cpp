#include "carom/ensemble/run_rows.hpp"

#include "carom/ensemble/sampler.hpp"

namespace carom {

using geometry::Vector;

namespace {

Vector unwrapped(const Table& table, Vector position, const geometry::Cell& cell) {
  return table.lattice ? position + table.lattice->translation(cell) : position;
}

}  // namespace

HitRow hit_row(const HitEvent& event, const Table& table,
               const std::vector<geometry::CurveFrame>& frames) {
  const geometry::CurveFrame& frame = frames[static_cast<std::size_t>(event.wall)];
  const Vector x = unwrapped(table, event.position, event.cell);
  return {event.particle,
          event.wall,
          event.u,
          geometry::arc_length_at(frame, event.u),
          dot(event.after, geometry::tangent_at(frame, event.u)),
          event.time.value(),
          x.x,
          x.y,
          event.after.x,
          event.after.y,
          event.cell.first,
          event.cell.second,
          event.reflections};
}

SampleRow sample_row(int particle, Time time, const State& state, const Table& table) {
  const Vector x = unwrapped(table, state.position, state.cell);
  State folded = state;
  fold_into_cell(table, folded.position, folded.cell);
  return {particle,          time.value(),      x.x, x.y, state.velocity.x, state.velocity.y,
          folded.cell.first, folded.cell.second};
}

}  // namespace carom
