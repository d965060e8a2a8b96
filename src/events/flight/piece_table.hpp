// A table made ready for flights, once: the pieces of its walls, prepared for double and for exact
// arithmetic.
//
// It is never changed after it is made, so the worlds of all threads share what is large: copies
// are cheap. HitFinder (next_hit.hpp) has what is written during a flight.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/pair.hpp"
#include "carom/events/decisions.hpp"
#include "carom/geometry/exact_flight.hpp"
#include "carom/table/table.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/enclosure.hpp"
#include "events/flight/flight.hpp"
#include "events/flight/wall_grid.hpp"

namespace carom::events {

class ChainTree;

struct PieceTable {
  /// `edges`: with the edges of the lattice cell, and flights start in the domain (else anywhere).
  /// `complement`: every wall turned round, so that the domain becomes the obstacle. Refers to the
  /// table.
  explicit PieceTable(const Table& table, DecisionOptions options = {}, bool edges = true,
                      bool complement = false);

  // Starts of flights.
  /// Makes a flight ready whose start, velocity and omega are set: for lattices it is put into the
  /// cell that contains its start, by exact decisions.
  void begin(Flight& flight) const;
  /// A flight from the exact point (wall, u), whose rounded image is `point`; omega and speed are
  /// kept.
  void begin_on_wall(Flight& flight, int wall, double u, geometry::Vector point,
                     geometry::Vector velocity) const {
    begin_on_wall(flight, wall, curve(wall), u, point, velocity);
  }
  /// The same where the caller has the wall's curve.
  void begin_on_wall(Flight& flight, int wall, const geometry::PreparedCurve& curve, double u,
                     geometry::Vector point, geometry::Vector velocity) const;
  /// Sets the start alone, off the wall's joints.
  static void put_on_wall(Flight& flight, int wall, const geometry::PreparedCurve& curve, double u,
                          geometry::Vector point, geometry::Vector velocity);
  /// A flight from there, where the point is surely in its own cell.
  static void begin_off_joints(Flight& flight, int wall, const geometry::PreparedCurve& curve,
                               double u, geometry::Vector point, geometry::Vector velocity);
  /// Is the start strictly inside the cell (or on its edge, see locate)?
  bool in_cell(const Flight& flight) const;
  /// Follows the flight over the edge that `ahead` names.
  void cross(Flight& flight, const Ahead& ahead) const;
  /// The same over an edge (piece), for a particle that leaves the wall it was on behind.
  void cross_edge(Flight& flight, int edge) const;

  // Ends of flights.
  /// Parameter on the wall where the flight meets it, and the wall's own cell.
  struct Landing {
    int wall = -1;
    int hole = -1;
    geometry::Cell cell;
    geometry::Vector velocity;  ///< on arrival
    geometry::PreparedCurve::Arrival at;
    const geometry::PreparedCurve* curve = nullptr;
  };
  void land(const Flight& flight, const Ahead& ahead, Landing& landing,
            DecisionCounts& counts) const;
  Landing land(const Flight& flight, const Ahead& ahead, DecisionCounts& counts) const {
    Landing landing;
    land(flight, ahead, landing, counts);
    return landing;
  }
  /// Where a flight ends that is seen to start at `origin`, and its velocity there.
  static geometry::Vector end_of(const Flight& flight, const Ahead& ahead, geometry::Vector origin,
                                 geometry::Vector& velocity);
  /// Does v at (wall, u) point into the domain? At u = 0 this is asked of both walls of the joint.
  /// `normal`: a rounded normal there.
  Sign inward(int wall, double u, geometry::Vector v, geometry::Vector normal,
              DecisionCounts& counts) const {
    return inward(wall, curve(wall), u, v, normal, counts);
  }
  Sign inward(int wall, const geometry::PreparedCurve& curve, double u, geometry::Vector v,
              geometry::Vector normal, DecisionCounts& counts) const;
  /// The same off the joints, as far as doubles tell.
  [[gnu::always_inline]] Sign inward_off_joints(const geometry::PreparedCurve& curve,
                                                geometry::Vector v, geometry::Vector normal) const {
    const double bound =
        options.filter_inflation * curve.normal_bound * (std::fabs(v.x) + std::fabs(v.y));
    return sign_within(dot(normal, v), bound);
  }
  /// Error of kappa of what lies ahead.
  double error_of(const Flight& flight, const Ahead& ahead) const;

  // Crossings of one flight with one piece (candidates.cpp).
  /// The start as pieces see it that are displaced by the offset of that number.
  Origin origin_of(const Flight& flight, int offset) const;
  /// The crossing that leaves through the piece's curve, without its error. Not for Larmor circles
  /// against ellipses.
  Crossing crossing_of(const Flight& flight, int piece, const Origin& origin, bool on_wall) const;
  /// Larmor circle against an ellipse: its first exit through the piece, if any, with its error.
  Sign first_exit(const Flight& flight, int piece, const Origin& origin, double inflation,
                  Crossing& crossing) const;
  /// A line against a Bézier curve: its first exit through the piece, if any, with its error.
  Sign bezier_exit(const Flight& flight, int piece, const Origin& origin, double inflation,
                   Crossing& crossing) const;
  /// Both joints of an arc lie on one side: does the flight leave through it all the same?
  Sign crossed_twice(const Flight& flight, int piece, const Origin& origin) const;
  geometry::ExactFlight exact_flight(const Flight& flight) const;

  /// Certainly inside: in a convex table on the left of the chords of all walls, beyond rounding.
  /// False: not known.
  bool surely_inside(geometry::Vector point) const;

  const geometry::PreparedCurve& curve(int wall) const {
    return curves[static_cast<std::size_t>(wall)];
  }
  /// The first of the walls that are arcs of one ellipse with this one, or -1: the wall is no such
  /// arc.
  int ellipse_of(int wall) const { return piece(wall).ellipse; }
  int wall_of(int number) const { return piece(number).wall; }
  /// Unit normal at the end of a wall.
  geometry::Vector normal_at_end(int wall) const {
    return shared_->end_normals[static_cast<std::size_t>(wall)];
  }
  bool is_quartic(const Flight& flight, int number) const {
    return flight.omega != 0.0 && piece(number).kind == geometry::CurveKind::ellipse;
  }
  /// Is the number of a crossing with that piece the exact stage's? The formulas misplace hits on
  /// thin walls, but those of flights that begin there.
  bool is_rough(const Flight& flight, int number) const {
    return thin && piece(number).shape->thin() &&
           (!is_on(flight, number) || is_quartic(flight, number));
  }
  static bool is_on(const Flight& flight, int piece) {
    return piece == flight.start_piece || piece == flight.start_previous;
  }

  struct PieceData {
    const geometry::PreparedCurve* shape = nullptr;
    int curve = 0;   ///< index into curves
    int wall = -1;   ///< -1: edge of the cell
    int offset = 0;  ///< index into offsets
    int next = 0, previous = 0;
    bool edge = false;
    bool closed = false;
    geometry::CurveKind kind = geometry::CurveKind::segment;
    bool within = false;  ///< of a wall in its own cell: it touches none of the cell's edges
    bool holed = false;   ///< its wall has holes
    int ellipse = -1;     ///< arcs of one: the first of its walls
  };
  /// Two entries of a grid cell's list, each a disc that the piece lies in, as seen from this cell
  /// of the lattice: one line of memory for what is seldom hit.
  struct alignas(64) Near {
    base::Pair x, y;  ///< centre
    /// Squared radius of a disc that is the piece and has the domain outside; else the negative of
    /// that of a disc around the piece.
    base::Pair r2;
    std::array<int, 2> piece, offset;
  };
  const PieceData& piece(int number) const { return data[static_cast<std::size_t>(number)]; }

  const Table& table;
  const DecisionOptions options;
  const bool cells;                                 ///< on a lattice
  bool displaced = false;                           ///< walls of other cells reach into this one
  bool thin = false;                                ///< a wall is thin (table/thin_walls.hpp)
  int first_edge = 0;                               ///< of the cell, among the pieces
  double reach = 0.0;                               ///< bounds the l1 norm of every joint
  std::span<const geometry::PreparedCurve> curves;  ///< walls, then edges
  std::span<const PieceData> data;                  ///< the walls in their own cell come first
  std::span<const geometry::Vector> joints;         ///< start of each piece in its own cell
  std::span<const int> open;                        ///< pieces that have joints
  std::span<const geometry::Cell> offsets;          ///< distinct displacements; the first is zero
  const geometry::ExactBoundary* exact = nullptr;   ///< the pieces for the exact stage

  // Convex tables.
  Enclosure enclosure;      ///< a convex loop around `discs`, or empty
  int enclosure_first = 0;  ///< its first piece
  std::span<const int> discs;
  bool convex = false;              ///< all walls are the enclosure: there is nothing in it
  double enclosure_rounding = 0.0;  ///< error of a joint's distance in it, if so
  double side_bound = 0.0;    ///< … on which side of a line it is: by the l1 norm of velocity
  double inside_bound = 0.0;  ///< … and on which side of a chord points are, as surely_inside asks
  bool without_ellipses = false;
  /// Not convex, but of few walls that are segments or arcs with the domain inside: all of them, as
  /// the joints on the right of a line from a wall tell its exit; or empty.
  Enclosure signs;
  bool discs_within = false;  ///< no disc touches an edge: a particle on a disc is in its cell

  const WallGrid* grid = nullptr;   ///< of tables with many walls, else null
  std::span<const Near> near;       ///< its lists
  double near_reach = 0.0;          ///< bounds the l1 norm of all their centres …
  double near_error = 0.0;          ///< … and their errors, a coordinate
  const ChainTree* tree = nullptr;  ///< of those among them with long loops, not on a lattice
  const std::vector<int>& all() const { return shared_->all; }  ///< numbers of all pieces

 private:
  struct Shared {
    std::vector<geometry::PreparedCurve> curves;
    std::vector<PieceData> data;
    std::vector<geometry::Vector> joints;
    std::vector<int> open;
    std::vector<geometry::Cell> offsets;
    std::vector<int> all, discs;
    std::vector<Near> near;
    std::vector<geometry::Vector> end_normals;  ///< a wall
    std::vector<int> opposite;                  ///< an edge: the one that a flight comes in by
    std::unordered_multimap<int, int> images;   ///< by wall: its pieces in other cells
    std::unique_ptr<const geometry::ExactBoundary> exact;
    std::unique_ptr<const WallGrid> grid;
    std::unique_ptr<const ChainTree> tree;
  };
  class Preparation;

  int edge_crossed_at_start(const Flight& flight) const;
  void find_start(Flight& flight) const;
  bool is_on_ellipse(const Flight& flight, int piece) const;
  Sign on_part(const Flight& flight, int piece, const Origin& origin, const Crossing& crossing,
               double inflation) const;
  Sign exactly_inward(int wall, double u, geometry::Vector v, DecisionCounts& counts) const;
  int hole_at(const Flight& flight, const Ahead& ahead, double u, DecisionCounts& counts) const;

  std::shared_ptr<const Shared> shared_;
};

[[gnu::always_inline]] inline Origin PieceTable::origin_of(const Flight& f, int offset) const {
  using geometry::unit_roundoff;
  Origin o{f.start,
           {f.start_error, norm_1(f.velocity), std::fabs(f.omega), options.filter_inflation}};
  if (!cells || !(displaced || (f.cell.first | f.cell.second) != 0)) return o;
  const geometry::Lattice& l = *table.lattice;
  const geometry::Cell by = offsets[static_cast<std::size_t>(offset)];
  const geometry::Cell c{f.cell.first + by.first, f.cell.second + by.second};
  o.point = l.seen_from(c, f.start);
  if (c == geometry::Cell{}) return o;
  // The start less one multiple, at most |start| + size, and the end; |start| is at most the end
  // and size.
  const double m = std::fabs(static_cast<double>(c.first)),
               n = std::fabs(static_cast<double>(c.second));
  const double size = m * norm_1(l.first) + n * norm_1(l.second);
  o.scale.delta += unit_roundoff * 2.1 * (size + norm_1(o.point));
  return o;
}

[[gnu::always_inline]] inline void PieceTable::cross_edge(Flight& f, int edge) const {
  const auto number = static_cast<std::size_t>(edge - first_edge);
  const geometry::Cell beyond = table.lattice->edges[number].beyond;
  f.cell.first += beyond.first;
  f.cell.second += beyond.second;
  f.entry = shared_->opposite[number];
}

[[gnu::always_inline]] inline void PieceTable::put_on_wall(Flight& f, int wall,
                                                           const geometry::PreparedCurve& w,
                                                           double u, geometry::Vector point,
                                                           geometry::Vector velocity) {
  f.wall = wall;
  f.u = u;
  f.start = point;
  f.start_error = w.point_error;
  f.velocity = velocity;
  f.start_previous = -1;
}

[[gnu::always_inline]] inline void PieceTable::begin_off_joints(Flight& f, int wall,
                                                                const geometry::PreparedCurve& w,
                                                                double u, geometry::Vector point,
                                                                geometry::Vector velocity) {
  put_on_wall(f, wall, w, u, point, velocity);
  f.cell.first = f.cell.second = 0;
  f.entry = -1;
  f.start_piece = wall;
}

[[gnu::always_inline]] inline void PieceTable::begin_on_wall(Flight& f, int wall,
                                                             const geometry::PreparedCurve& w,
                                                             double u, geometry::Vector point,
                                                             geometry::Vector velocity) const {
  begin_off_joints(f, wall, w, u, point, velocity);
  if (!discs_within && !(u > 0.0 && (!cells || piece(wall).within))) begin(f);
}

[[gnu::always_inline]] inline geometry::Vector PieceTable::end_of(const Flight& f,
                                                                  const Ahead& ahead,
                                                                  geometry::Vector origin,
                                                                  geometry::Vector& velocity) {
  if (f.omega == 0.0) {
    velocity = f.velocity;
    return geometry::moved(origin, ahead.duration, f.velocity);
  }
  const auto factors = geometry::flight_factors(ahead.kappa, f.omega, 0.5);
  velocity = geometry::turned_by(f.omega * factors.along, f.omega * factors.across, f.velocity);
  return origin + geometry::displacement(factors, f.velocity);
}

[[gnu::always_inline]] inline void PieceTable::land(const Flight& f, const Ahead& ahead,
                                                    Landing& landing,
                                                    DecisionCounts& counts) const {
  geometry::Vector origin = f.start;
  landing.wall = ahead.piece;  // the pieces begin with the walls in their own cell
  landing.cell.first = landing.cell.second = 0;
  if (cells) {
    const PieceData& p = piece(ahead.piece);
    landing.wall = p.wall;
    const geometry::Cell o = offsets[static_cast<std::size_t>(p.offset)];
    landing.cell = {f.cell.first + o.first, f.cell.second + o.second};
    if (displaced || (f.cell.first | f.cell.second) != 0)
      origin = table.lattice->seen_from(landing.cell, f.start);
  }
  const geometry::PreparedCurve& w = curves[static_cast<std::size_t>(landing.wall)];
  landing.curve = &w;
  landing.hole = -1;
  const geometry::Vector end = end_of(f, ahead, origin, landing.velocity);
  if (ahead.kind == Ahead::Kind::joint) {
    const geometry::PreparedCurve::Frame at = w.frame(0.0);
    landing.at.point = at.point;
    landing.at.normal = at.normal;
    landing.at.u = 0.0;
    return;
  }
  w.arrive(end, landing.velocity, landing.at, ahead.u);
  if (piece(ahead.piece).holed) landing.hole = hole_at(f, ahead, landing.at.u, counts);
}

[[gnu::always_inline]] inline Sign PieceTable::inward(int wall, const geometry::PreparedCurve& w,
                                                      double u, geometry::Vector v,
                                                      geometry::Vector normal,
                                                      DecisionCounts& counts) const {
  if (u > 0.0) {
    const Sign sign = inward_off_joints(w, v, normal);
    if (sign != Sign::undecided) {
      ++counts.filter;
      return sign;
    }
  }
  return exactly_inward(wall, u, v, counts);
}

}  // namespace carom::events
