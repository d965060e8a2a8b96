// Exact decisions about a flight: the last stage, which never answers "undecided".
//
// The boundary is a list of pieces: curves, each possibly displaced by a lattice vector. A flight
// starts at the exact point of a piece or at two doubles. All answers are signs of polynomials in
// these numbers, evaluated in integer arithmetic; quartics (a Larmor circle against an ellipse) go
// to CGAL's algebraic kernel.
//
// Laws, each a test:
// (1) side(joint) of two pieces that share a joint is one number: no flight slips between them.
// (2) exits(piece) has as many members as an exact count of the crossings that leave the domain.
// (3) order(x, y) == -order(y, x), and zero only for the same point of the plane and time.
#pragma once

#include <memory>
#include <vector>

#include "carom/base/sign.hpp"
#include "carom/geometry/curve.hpp"
#include "carom/geometry/lattice.hpp"

namespace carom::geometry {

/// A curve as exact decisions see it: what follows it, and where in the lattice it lies.
struct Piece {
  Curve curve;
  Cell offset;        ///< displaced by this lattice vector
  int next = 0;       ///< piece that starts at this one's end (itself if closed; -1: none)
  bool edge = false;  ///< edge of the lattice cell: it leads on instead of reflecting
};

/// The pieces of a table in integers, for decisions that are always right. Each piece is made when
/// it is first asked about; threads may share a boundary.
class ExactBoundary {
 public:
  ExactBoundary(const std::vector<Piece>& pieces, Vector first, Vector second);
  ~ExactBoundary();
  ExactBoundary(ExactBoundary&&) noexcept;

  /// Sign of the component of v along the inward normal at the exact point u of a piece.
  Sign inward(int piece, double u, Vector v) const;
  /// The same at the end of a piece.
  Sign inward_at_end(int piece, Vector v) const;

  /// How the piece `previous` meets the piece `next` that starts at its end.
  struct Corner {
    int turn;   ///< sign of the turn from the incoming to the outgoing tangent (> 0: left)
    int order;  ///< n when the interior angle is pi/n with n = 1, 2, 4 (1: common tangent), else 0
  };
  Corner corner(int previous, int next) const;

  /// Are both pieces, wherever they are displaced to, of one ellipse, given by the same axis and
  /// ratio?
  bool same_ellipse(int first, int second) const;

  struct Data;
  const Data& data() const { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// One flight over an ExactBoundary, straight or Larmor, in exact numbers.
class ExactFlight {
 public:
  /// From the exact point u of `piece` (u = 0: its start, shared with the piece before), or from
  /// the exact `point` if piece < 0. `cell` displaces the piece, with its own offset on top.
  ExactFlight(const ExactBoundary& boundary, int piece, double u, Vector point, Vector velocity,
              double omega);
  ~ExactFlight();

  /// What lies first ahead among the given pieces, all displaced by `cell`.
  struct First {
    enum class Kind { none, exit, joint, cusp } kind = Kind::none;
    int piece = -1;  ///< the piece left through, or the one that starts at the joint
    int root = 0;    ///< which of the piece's exits, counted along the flight (quartics, Bézier)
    double kappa = 0.0;  ///< rounded, for the rare crossing that doubles cannot resolve
    double u = 0.0;      ///< rounded, of a crossing with a Bézier curve
  };
  /// `entry`: the edge through which the flight came into this cell, or -1. Exits through edges
  /// before that crossing do not count. `start` tells which piece of the list, if any, is the one
  /// the particle is on, and `start_previous` the one that ends there if it is on a joint.
  First first(const std::vector<int>& pieces, Cell cell, int entry, int start,
              int start_previous) const;

  /// Side of the flight on which the exact point u of a piece lies (u < 0: its end).
  Sign side(int piece, double u, Cell cell) const;
  /// Does the exit of `piece` (root as answered by first) lie within [from, to) of its parameter?
  /// `to` < 0 means the end of the piece.
  bool exit_within(int piece, int root, Cell cell, double from, double to, bool start) const;
  /// Is the start point in the half plane left of (or on) the line of a segment piece?
  Sign left_of(int piece, Cell cell) const;

  struct Data;

 private:
  std::unique_ptr<Data> data_;
};

}  // namespace carom::geometry
