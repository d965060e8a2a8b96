// Which wall a flight meets first: the choosing driver of the event loop.
//
// Decisions are taken in double precision with derived bounds; where one of them cannot tell, the
// whole flight is decided again in exact arithmetic. Numbers (kappa, time, point) come from the
// same formulas in double precision either way, so that bounds never show in a result.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "carom/events/decisions.hpp"
#include "carom/geometry/exact_flight.hpp"
#include "carom/geometry/filter.hpp"
#include "carom/geometry/quartic.hpp"
#include "carom/table/table.hpp"
#include "base/angle.hpp"
#include "events/flight/enclosure.hpp"
#include "events/flight/wall_grid.hpp"

namespace carom {

/// A flight under way, in the frame of the cell where it started.
struct Flight {
  int wall = -1;  ///< start: wall and u, or a free point
  double u = 0.0;
  geometry::Vector start;  ///< rounded image (exact for a free point)
  double start_error = 0.0;
  geometry::Vector velocity;
  double omega = 0.0;
  /// The squared speed of the energy shell, to which |v|^2 is equal within 64u: a constant, for
  /// rounding |v|^2 anew about a power of two would bias every flight the same way.
  double square_speed = 1.0;
  geometry::Cell cell;  ///< the cell it is in, relative to the one of its start
  int entry = -1;       ///< edge (piece) through which it came into `cell`
  // Set by HitFinder::begin and cross: the piece the particle stands on, as seen from `cell` (-1:
  // none), and, at a joint, the piece that ends there.
  int start_piece = -1;
  int start_previous = -1;
};

/// What lies first ahead.
struct Ahead {
  enum class Kind : unsigned char { none, wall, edge, joint, cusp } kind = Kind::none;
  int piece = -1;
  int root = 0;
  double kappa = 0.0;
  double duration = 0.0;  ///< time from the start of the flight
};

class HitFinder {
 public:
  /// `edges`: with the edges of the lattice cell, and flights start in the domain (else anywhere).
  /// `complement`: every wall turned round, so that the domain becomes the obstacle.
  explicit HitFinder(const Table& table, DecisionOptions options = {}, bool edges = true,
                     bool complement = false);
  ~HitFinder();

  /// Makes a flight ready whose start, velocity and omega are set: for lattices it is put into the
  /// cell that contains its start, by exact decisions.
  void begin(Flight& flight) const;
  /// A flight from the exact point (wall, u), whose rounded image is `point`; omega and speed are
  /// kept.
  void begin_on_wall(Flight& flight, int wall, double u, geometry::Vector point,
                     geometry::Vector velocity) const {
    begin_on_wall(flight, wall, curve(wall), u, point, velocity);
  }
  /// The same for who has the wall's curve at hand.
  void begin_on_wall(Flight& flight, int wall, const geometry::PreparedCurve& curve, double u,
                     geometry::Vector point, geometry::Vector velocity) const;

  void next(const Flight& flight, Ahead& ahead, DecisionCounts& counts) const;
  Ahead next(const Flight& flight, DecisionCounts& counts) const {
    Ahead ahead;
    next(flight, ahead, counts);
    return ahead;
  }

  /// Certainly inside: in a convex table on the left of the chords of all walls, beyond rounding.
  /// False: not known.
  bool surely_inside(geometry::Vector point) const;

  /// Follows the flight over the edge that `ahead` names.
  void cross(Flight& flight, const Ahead& ahead) const;

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

  /// Does v at (wall, u) point into the domain? At u = 0 this is asked of both walls of the joint.
  /// `normal`: a rounded normal there.
  Sign inward(int wall, double u, geometry::Vector v, geometry::Vector normal,
              DecisionCounts& counts) const {
    return inward(wall, curve(wall), u, v, normal, counts);
  }
  Sign inward(int wall, const geometry::PreparedCurve& curve, double u, geometry::Vector v,
              geometry::Vector normal, DecisionCounts& counts) const;
  /// Error of kappa of what lies ahead.
  double error_of(const Flight& flight, const Ahead& ahead) const;
  /// Is the start strictly inside the cell (or on its edge, see locate)?
  bool in_cell(const Flight& flight) const;

  const geometry::PreparedCurve& curve(int wall) const {
    return curves_[static_cast<std::size_t>(wall)];
  }
  const Table& table() const { return table_; }
  const geometry::ExactBoundary& exact() const { return *exact_; }
  /// The first of the walls that are arcs of one ellipse with this one, or -1: the wall is no such
  /// arc.
  int ellipse_of(int wall) const { return data_[static_cast<std::size_t>(wall)].ellipse; }
  int wall_of(int piece) const { return data_[static_cast<std::size_t>(piece)].wall; }
  /// Unit normal at the end of a wall.
  geometry::Vector normal_at_end(int wall) const {
    return end_normals_[static_cast<std::size_t>(wall)];
  }

 private:
  struct PieceData {
    const geometry::PreparedCurve* shape = nullptr;
    int curve = 0;   ///< index into curves_
    int wall = -1;   ///< -1: edge of the cell
    int offset = 0;  ///< index into offsets_
    int next = 0, previous = 0;
    bool edge = false;
    bool closed = false;
    geometry::CurveKind kind = geometry::CurveKind::segment;
    int ellipse = -1;  ///< arcs of one: the first of its walls
  };
  /// The start of a flight seen from its cell, displaced by one offset.
  struct Origin {
    geometry::Vector point;
    geometry::FlightScale scale;
  };
  /// A crossing that may be the first.
  struct Candidate {
    geometry::Quadratic<double> quadratic;
    geometry::QuadraticError error{};
    geometry::Root root;
    double kappa_error = -1.0;  ///< negative: not computed yet
  };

  void add_piece(const geometry::Curve& curve, int curve_index, int wall, geometry::Cell offset,
                 bool edge);
  /// Loops of walls, each named by one of its walls, that reach into the cell displaced by
  /// `offset`.
  struct Images {
    geometry::Cell offset;
    std::vector<int> loops;
  };
  void find_ellipses();
  void add_walls(geometry::Cell offset, bool complement, const std::vector<int>& loops);
  std::vector<Images> images() const;
  int edge_crossed_at_start(const Flight& flight) const;
  /// Sees the walls from the flight's start, in its cell. Number by number: a 16-byte copy of two
  /// numbers that were just stored one by one would wait for them.
  void look_from(const Flight& f) const {
    Origin& own = origins_[0];
    own.point.x = f.start.x;
    own.point.y = f.start.y;
    own.scale.delta = f.start_error;
    own.scale.speed_1 = std::fabs(f.velocity.x) + std::fabs(f.velocity.y);
    own.scale.omega = std::fabs(f.omega);
    own.scale.inflation = options_.filter_inflation;
    if (cells_ && (displaced_ || (f.cell.first | f.cell.second) != 0)) look_at_cells(f);
  }
  void look_at_cells(const Flight& flight) const;
  Candidate candidate(const Flight& flight, int piece, bool stands_on_it) const;
  /// Larmor circle against an ellipse: its first exit through the piece, if any.
  Sign quartic_candidate(const Flight& flight, int piece, double inflation, Candidate& c) const;
  Sign on_part(const Flight& flight, int piece, const Candidate& c, double inflation) const;
  bool is_quartic(const Flight& flight, int piece) const {
    return flight.omega != 0.0 &&
           curves_[static_cast<std::size_t>(data_[static_cast<std::size_t>(piece)].curve)].kind ==
               geometry::CurveKind::ellipse;
  }
  bool stands_on(const Flight& flight, int piece) const {
    return piece == flight.start_piece || piece == flight.start_previous;
  }
  /// On the ellipse that the piece is an arc of?
  bool stands_on_ellipse(const Flight& flight, int piece) const {
    const PieceData& p = data_[static_cast<std::size_t>(piece)];
    const auto begins_on = [&](int start) {
      if (start < 0) return false;
      const PieceData& s = data_[static_cast<std::size_t>(start)];
      return start == piece || (p.ellipse >= 0 && s.ellipse == p.ellipse && s.offset == p.offset);
    };
    return begins_on(flight.start_piece) || begins_on(flight.start_previous);
  }
  template <bool larmor, bool cells>
  bool filtered(const Flight& flight, Ahead& ahead) const {
    double unused = 0.0;
    return filtered_of<larmor, cells, false>(flight, ahead, {}, unused);
  }
  /// The same among some pieces (`listed`), with the error of kappa.
  template <bool larmor, bool cells, bool listed>
  bool filtered_of(const Flight& flight, Ahead& ahead, std::span<const int> list,
                   double& error) const;
  template <bool larmor, bool cells>
  bool see_joints(const Flight& flight, std::span<const int> list) const;
  Sign crossed_twice(const Flight& flight, int piece) const;
  double kappa_error_of(const Flight& flight, int piece) const;
  void next_of_all(const Flight& flight, Ahead& ahead, DecisionCounts& counts) const;
  void find_enclosure(bool complement);
  bool filtered_enclosed(const Flight& flight, Ahead& ahead) const;
  bool line_in_enclosure(const Flight& flight, Ahead& ahead) const;
  bool circle_in_enclosure(const Flight& flight, Ahead& ahead) const;
  int exit_of_enclosure(const Flight& flight, geometry::Vector origin,
                        const geometry::FlightScale& scale) const;
  Ahead exact_next(const Flight& flight, const std::vector<int>& pieces) const;
  // Tables of many walls (grid_hit.cpp).
  void make_grid(bool edges);
  void next_in_grid(const Flight& flight, Ahead& ahead, DecisionCounts& counts) const;
  template <bool larmor, bool cells>
  bool filtered_in_grid(const Flight& flight, Ahead& ahead) const;
  /// An entry of a cell's list, with all that a line asks of a disc: one place in memory for what
  /// is seldom hit.
  struct Near {
    double x, y, r2, centre_error;
    int piece, offset;
    bool disc, domain_outside;
  };
  /// The first disc of those that a line is certain to enter from outside.
  struct FirstDisc {
    int piece = -1;
    double time = 0.0, unit = 1.0, kappa = 0.0, error = 0.0;
  };
  template <bool cells>
  Sign meets_disc(const Flight& flight, const Near& disc, FirstDisc& first) const;
  const std::vector<int>& pieces_on_way(const Flight& flight) const;
  template <class Visit, class Passed>
  void follow(const Flight& flight, const Visit& visit, const Passed& passed) const;
  void find_start(Flight& flight) const;
  geometry::ExactFlight exact_flight(const Flight& flight) const;
  Sign exactly_inward(int wall, double u, geometry::Vector v, DecisionCounts& counts) const;
  int hole_at(const Flight& flight, const Ahead& ahead, double u, DecisionCounts& counts) const;

  const Table& table_;
  DecisionOptions options_;
  std::vector<geometry::PreparedCurve> curves_;  // walls, then edges
  std::vector<PieceData> data_;
  std::vector<geometry::Vector> joints_;  // start of each piece in its own cell
  std::vector<int> open_;                 // pieces that have joints
  std::vector<geometry::Cell> offsets_;   // distinct displacements; the first is zero
  std::vector<geometry::Piece> pieces_;   // the same pieces for the exact stage
  std::vector<int> all_;
  std::vector<geometry::Vector> end_normals_;  // a wall
  std::vector<signed char> holed_;             // a wall: has it holes?
  bool cells_ = false;                         // on a lattice
  bool displaced_ = false;                     // walls of other cells reach into this one
  double reach_ = 0.0;                         // bounds the l1 norm of every joint
  int first_edge_ = 0;
  int enclosure_first_ = 0,
      enclosure_size_ = 0;  // pieces of a convex loop around discs_; size 0: none
  std::vector<int> discs_;
  Enclosure enclosure_;              // the walls of a convex table with nothing in it, else empty
  double enclosure_rounding_ = 0.0;  // error of a joint's distance in it
  bool without_ellipses_ = false;
  bool discs_within_ = false;  // they touch no edge: who leaves one is in its cell
  std::vector<int> opposite_;  // edge through which one comes in who leaves by this one
  std::unique_ptr<geometry::ExactBoundary> exact_;
  std::unique_ptr<const WallGrid> grid_;      // of tables with many walls, else null
  std::vector<Near> near_;                    // its lists
  std::unordered_multimap<int, int> images_;  // by wall: its pieces in other cells
  // Scratch of one flight; a finder belongs to one thread.
  mutable std::vector<Origin> origins_;
  mutable std::vector<unsigned char> left_;  // is the joint on the left of the flight?
  mutable std::vector<std::uint32_t> seen_;  // a piece: the last flight that came near it
  mutable std::uint32_t flights_ = 0;
  mutable std::vector<int> list_;  // pieces on the way of a flight
};

[[gnu::always_inline]] inline void HitFinder::begin_on_wall(Flight& f, int wall,
                                                            const geometry::PreparedCurve& w,
                                                            double u, geometry::Vector point,
                                                            geometry::Vector velocity) const {
  f.wall = wall;
  f.u = u;
  f.start = point;
  f.start_error = w.point_error;
  f.velocity = velocity;
  f.cell.first = f.cell.second = 0;
  f.entry = -1;
  if (!discs_within_ && (cells_ || !(u > 0.0))) return begin(f);
  f.start_piece = wall;
  f.start_previous = -1;
}

[[gnu::always_inline]] inline void HitFinder::land(const Flight& f, const Ahead& ahead,
                                                   Landing& landing, DecisionCounts& counts) const {
  geometry::Vector origin = f.start;
  landing.wall = ahead.piece;  // the pieces begin with the walls in their own cell
  landing.cell.first = landing.cell.second = 0;
  if (cells_) {
    look_from(f);  // the view may be another particle's
    const PieceData& p = data_[static_cast<std::size_t>(ahead.piece)];
    landing.wall = p.wall;
    const geometry::Cell o = offsets_[static_cast<std::size_t>(p.offset)];
    landing.cell = {f.cell.first + o.first, f.cell.second + o.second};
    origin = origins_[static_cast<std::size_t>(p.offset)].point;
  }
  const geometry::PreparedCurve& w = curves_[static_cast<std::size_t>(landing.wall)];
  landing.curve = &w;
  landing.hole = -1;
  const bool larmor = f.omega != 0.0;
  geometry::Vector end;
  if (larmor) {
    const auto factors = geometry::flight_factors(ahead.kappa, f.omega, 0.5);
    end = origin + geometry::displacement(factors, f.velocity);
    landing.velocity = geometry::turned(factors, f.velocity, f.omega);
  } else {
    end = geometry::moved(origin, ahead.duration, f.velocity);
    landing.velocity = f.velocity;
  }
  if (ahead.kind == Ahead::Kind::joint) {
    const geometry::PreparedCurve::Frame at = w.frame(0.0);
    landing.at.point = at.point;
    landing.at.normal = at.normal;
    landing.at.u = 0.0;
    return;
  }
  w.arrive(end, landing.velocity, landing.at);
  if (holed_[static_cast<std::size_t>(landing.wall)] != 0)
    landing.hole = hole_at(f, ahead, landing.at.u, counts);
}

[[gnu::always_inline]] inline Sign HitFinder::inward(int wall, const geometry::PreparedCurve& w,
                                                     double u, geometry::Vector v,
                                                     geometry::Vector normal,
                                                     DecisionCounts& counts) const {
  if (u > 0.0) {
    const double bound =
        options_.filter_inflation * w.normal_bound * (std::fabs(v.x) + std::fabs(v.y));
    const Sign sign = sign_within(dot(normal, v), bound);
    if (sign != Sign::undecided) {
      ++counts.filter;
      return sign;
    }
  }
  return exactly_inward(wall, u, v, counts);
}

/// Duration of a flight to kappa.
[[gnu::always_inline]] inline double duration_at(double kappa, double omega) {
  if (omega == 0.0) return 1.0 / kappa;
  const double h = 0.5 * std::fabs(omega);
  return elementary::angle(kappa, h) * (1.0 / h);  // nobody waits for this quotient
}

}  // namespace carom

#include "events/flight/enclosed_hit.hpp"  // the inline functions of convex tables
