#include "events/flight/locator.hpp"

namespace carom::events {

using namespace geometry;

namespace {

Table without_walls(const Table& table) {
  Table bare;
  bare.extent = table.extent;
  bare.lattice = table.lattice;
  return bare;
}

}  // namespace

Locator::Locator(const Table& table, const DecisionOptions& options)
    : domain_(PieceTable(table, options, false, false)),
      complement_(PieceTable(table, options, false, true)),
      bare_(without_walls(table)),
      cell_(bare_, options),
      touch_(table, options.grid_from) {}

bool Locator::contains(Vector point) {
  if (touch_.on_wall(point)) return false;
  Flight flight;
  flight.start = point;
  // Directions of rational slope in different octants; one that meets no tie is enough.
  for (const Vector& direction :
       {Vector{0.5625, 0.828125}, Vector{-0.875, 0.484375}, Vector{0.203125, -0.984375},
        Vector{-0.6875, -0.71875}, Vector{0.984375, 0.171875}, Vector{-0.09375, 0.984375}}) {
    flight.velocity = direction;
    flight.square_speed = dot(direction, direction);
    // A point on an edge of the cell is in it when one looks inwards.
    if (domain_.pieces().table.lattice && !cell_.in_cell(flight)) continue;
    DecisionCounts counts;
    flight.start_piece = -1;
    const Ahead leave = domain_.next(flight, counts);
    const Ahead enter = complement_.next(flight, counts);
    const bool leaves = leave.kind == Ahead::Kind::wall, enters = enter.kind == Ahead::Kind::wall;
    if (leave.kind == Ahead::Kind::none && enter.kind == Ahead::Kind::none)
      return domain_.pieces().table.extent != Extent::bounded;
    if (leave.kind != Ahead::Kind::none && enter.kind == Ahead::Kind::none) return true;
    if (enter.kind != Ahead::Kind::none && leave.kind == Ahead::Kind::none) return false;
    if (!leaves || !enters) continue;
    const double margin =
        domain_.pieces().error_of(flight, leave) + complement_.pieces().error_of(flight, enter);
    const Sign order = sign_within(leave.kappa - enter.kappa, margin);
    if (order == Sign::positive) return true;
    if (order == Sign::negative) return false;
  }
  return false;  // on a wall, or nearer to one than rounding tells from every side
}

}  // namespace carom::events
