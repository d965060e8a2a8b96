// The walls of a table as functions of a parameter, with the numbers as they were written.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "carom/table/table_spec.hpp"
#include "certify/number/series.hpp"
#include "certify/wall/wall.hpp"
#include "table/shapes.hpp"

namespace carom::certify {

/// A point with its first two derivatives.
struct CurvePlace {
  BallVector point, first, second;
};

inline geometry::Vector in_doubles(const BallVector& v) {
  return {v.x.to_double(), v.y.to_double()};
}

/// A smooth piece of the walls: one wall, or all of a closed curve that was written as formulas.
class Piece {
 public:
  virtual ~Piece() = default;
  /// Its series about all parameters of a ball.
  virtual VectorOf<Series> about(const Ball& t) const = 0;
  CurvePlace at(const Ball& t) const {
    const Series::Terms three(3);
    const VectorOf<Series> s = about(t);
    return {{s.x[0], s.y[0]}, {s.x[1], s.y[1]}, {Ball(2) * s.x[2], Ball(2) * s.y[2]}};
  }
  /// The parameter of the point with parameter u of the wall in doubles, and back.
  virtual Ball parameter(double u) const { return u; }
  virtual double u_of(double t) const { return t; }

  Ball from = 0, length = 1;
  double turn = 1.0;      ///< -1: the table's walls run the other way
  bool periodic = false;  ///< Does it repeat after its length, and is the curve beyond its ends?
};

/// A Bézier curve or a segment.
class PolynomialPiece final : public Piece {
 public:
  explicit PolynomialPiece(std::vector<BallVector> control);
  explicit PolynomialPiece(const geometry::Bezier&);
  VectorOf<Series> about(const Ball& t) const override;

 private:
  Series x_, y_;
};

/// All of them, to the present precision.
class Pieces {
 public:
  /// `shape`: that of the table (table::shapes::written_shape).
  Pieces(const TableSpec&, const table::shapes::Shape& shape);

  struct Spot {
    std::size_t piece;
    Ball t;
  };
  std::size_t size() const { return pieces_.size(); }
  const Piece& operator[](std::size_t k) const { return *pieces_[k].piece; }
  /// The point of a table's wall, and the wall on which one is, of one or more rounds.
  Spot spot(int wall, double u) const;
  std::pair<int, double> wall_at(const Spot&) const;
  /// Where a wall begins and ends, and how many walls its piece has.
  struct Ends {
    std::size_t piece;
    Ball first, last;
    std::size_t of;
  };
  Ends ends(int wall) const;

 private:
  struct Walls {
    std::unique_ptr<const Piece> piece;
    std::size_t first, count;  ///< its walls
  };
  void add(std::unique_ptr<Piece>, std::size_t walls);

  std::vector<Walls> pieces_;
  struct Part {
    std::size_t piece;
    double from, to;  ///< Of a curve of formulas: the parameters at its ends.
  };
  std::vector<Part> parts_;  ///< by walls
};

}  // namespace carom::certify
