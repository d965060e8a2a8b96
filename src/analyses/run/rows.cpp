#include "carom/analyses/run/rows.hpp"

#include "base/interrupt.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "carom/geometry/arc_lengths.hpp"
#include "carom/starts/sampler.hpp"
#include "carom/system/section.hpp"

namespace carom {

using geometry::Vector;

namespace {

Vector unwrapped(const Table& table, Vector position, const geometry::Cell& cell) {
  return table.lattice ? position + table.lattice->translation(cell) : position;
}

HitRow row_with(const HitEvent& event, const Table& table, const geometry::CurveFrame& frame,
                double s) {
  const Vector x = unwrapped(table, event.position, event.cell);
  return {event.particle,
          event.wall,
          s,
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

}  // namespace

HitRow hit_row(const HitEvent& event, const Table& table,
               const std::vector<geometry::CurveFrame>& frames) {
  const geometry::CurveFrame& frame = frames[static_cast<std::size_t>(event.wall)];
  return row_with(event, table, frame, geometry::arc_length_at(frame, event.u));
}

HitRows::HitRows(const Table& table) : table_(table), frames_(frames_of(table)) {}

void HitRows::add(const HitEvent& event) {
  const geometry::CurveFrame& frame = frames_[static_cast<std::size_t>(event.wall)];
  rows_.push_back(row_with(event, table_, frame, 0.0));
  walls_.push_back(event.wall);
  places_.push_back(event.u);
}

std::vector<HitRow> HitRows::take() {
  const std::vector<double> lengths = geometry::arc_lengths_at(frames_, walls_, places_);
  for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].s = lengths[i];
  walls_.clear();
  places_.clear();
  std::vector<HitRow> next;
  next.reserve(some);
  return std::exchange(rows_, std::move(next));
}

SampleRow sample_row(int particle, Time time, const State& state, const Table& table) {
  const Vector x = unwrapped(table, state.position, state.cell);
  State folded = state;
  fold_into_cell(table, folded.position, folded.cell);
  return {particle,          time.value(),      x.x, x.y, state.velocity.x, state.velocity.y,
          folded.cell.first, folded.cell.second};
}

std::vector<SampleRow> start_rows(const World& world, const Table& table) {
  std::vector<SampleRow> rows;
  for (int i = 0; i < world.size(); ++i)
    rows.push_back(sample_row(i, Time(0.0), world.state(i), table));
  return rows;
}

ContactRow contact_row(const ContactEvent& e, const Table& table) {
  const Vector x = unwrapped(table, e.first_position, e.first_cell),
               y = unwrapped(table, e.second_position, e.second_cell);
  return {e.first,
          e.second,
          e.time.value(),
          x.x,
          x.y,
          y.x,
          y.y,
          e.separation.x,
          e.separation.y,
          e.first_after.x,
          e.first_after.y,
          e.second_after.x,
          e.second_after.y,
          e.transfer};
}

bool EnergyRows::wanted() const { return system_.of_discs() || system_.has_forces(); }

void EnergyRows::sample(int particle, const State& state) {
  if (!wanted()) return;
  particles_.push_back(system_.particles.at(static_cast<std::size_t>(particle)));
  states_.push_back(state);
}

bool EnergyRows::sampled(Time time, std::optional<EnergyRow>& row) {
  row.reset();
  if (states_.empty()) return true;
  const Table& table = *system_.table;
  base::Interrupt summing(&interrupted_);
  const Energy energy = energy_of(particles_, states_, system_.dynamics, table, &summing);
  if (!summing.stopped()) {
    const Vector momentum = momentum_of(particles_, states_);
    row = {time.value(),    energy.kinetic,
           energy.external, energy.pair,
           energy.total(),  momentum.x,
           momentum.y,      angular_momentum_of(particles_, states_, table)};
  }
  particles_.clear();
  states_.clear();
  return row.has_value();
}

}  // namespace carom
