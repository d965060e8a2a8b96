// Many walls: the plane cut into cells, each with the pieces that may reach into it, and the cells
// that a flight may pass. Clearings, squares of empty cells, are passed in one leap.
// docs/developer/many-walls.md derives the bounds.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "carom/geometry/exact_flight.hpp"
#include "carom/geometry/formulas.hpp"
#include "carom/geometry/prepared_curve.hpp"

namespace carom::events {

/// An axis cut into parts at increasing doubles. A number below the first cut is of the first part,
/// one beyond the last of the last. part() never falls as x grows: so a point that two boxes share
/// is of a part that both of them reach, however the cuts were rounded.
class CutAxis {
 public:
  CutAxis() = default;
  CutAxis(double low, double high, int parts);

  int parts() const { return static_cast<int>(cuts_.size()) - 1; }
  double low() const { return cuts_.front(); }
  double high() const { return cuts_.back(); }
  double cut(int i) const { return cuts_[static_cast<std::size_t>(i)]; }
  /// Is every number from `low` to `high` of a part from `first` to `end`?
  bool within(double low, double high, int first, int end) const {
    return (first <= 0 || low >= cut(first)) && (end >= parts() - 1 || high < cut(end + 1));
  }
  /// Parts in a unit of length, about.
  double density() const { return inverse_; }
  /// The part of x, or another one: x is beyond its cuts by no more than 16u of the largest |cut|.
  int part_about(double x) const {
    // inverse_ errs by 2u of itself, the difference and the product by u: 4.1u of high - low; the
    // cuts by 3.1u of that and u of themselves.
    return static_cast<int>(
        std::min(static_cast<double>(parts() - 1), std::max(0.0, (x - cuts_.front()) * inverse_)));
  }
  int part(double x) const {
    const int last = parts() - 1;
    int i = part_about(x);
    while (i > 0 && x < cut(i)) --i;
    while (i < last && x >= cut(i + 1)) ++i;
    return i;
  }

 private:
  std::vector<double> cuts_{0.0, 0.0};
  double inverse_ = 0.0;
};

/// A straight line, seen along the axis on which it advances most: b = b0 + (a - a0) slope, |slope|
/// <= 1.
struct Course {
  bool upright = false;  ///< a is y
  double a0 = 0.0, b0 = 0.0, slope = 0.0;
  double speed = 0.0;   ///< da/dt
  double margin = 0.0;  ///< what the point's error costs

  /// From a point known to `delta` a coordinate.
  Course(geometry::Vector point, double delta, geometry::Vector direction) {
    upright = std::fabs(direction.y) > std::fabs(direction.x);
    a0 = upright ? point.y : point.x;
    b0 = upright ? point.x : point.y;
    speed = upright ? direction.y : direction.x;
    slope = (upright ? direction.x : direction.y) / speed;
    // b errs by delta, and by slope delta for the error of a; the part of the line that is looked
    // at begins up to delta before or after a0: 3 delta. The last digits: b0 itself is rounded in b
    // and in its ends.
    margin = 3.1 * delta + 4.0 * geometry::unit_roundoff * std::fabs(b0);
  }
  struct Range {
    double low, high;
  };
  /// Contains every b of the line between two numbers of a.
  Range between(double from, double to) const {
    const double p = (from - a0) * slope, q = (to - a0) * slope;
    // p errs by 3u of itself, the sum by u of both, the ends by u of what they are.
    const double most =
        margin + 8.0 * geometry::unit_roundoff * std::max(std::fabs(p), std::fabs(q));
    return {b0 + std::min(p, q) - most, b0 + std::max(p, q) + most};
  }
};

class WallGrid {
 public:
  /// The pieces of a boundary within a box: outside of it nothing is looked for.
  WallGrid(const std::vector<geometry::Piece>& pieces, geometry::Vector first,
           geometry::Vector second, const geometry::Box& within);

  /// The pieces of a cell that was visited. They stand in pairs: an odd list ends with its last
  /// piece twice.
  std::span<const int> pieces(int cell) const {
    const auto first = starts_[static_cast<std::size_t>(cell)],
               end = starts_[static_cast<std::size_t>(cell) + 1];
    return {list_.data() + first, end - first};
  }
  /// The pieces of the cell of a point.
  std::span<const int> pieces_at(geometry::Vector x) const {
    const int cell = place(columns_.part(x.x), rows_.part(x.y));
    return cell < 0 ? std::span<const int>() : pieces(cell);
  }
  /// The index of a cell's first pair among those of all cells, one after the other.
  std::size_t first_pair(int cell) const { return starts_[static_cast<std::size_t>(cell)] / 2; }
  const std::vector<int>& entries() const { return list_; }
  int columns() const { return columns_.parts(); }
  int rows() const { return rows_.parts(); }

  /// Has the cell in a column and a row no piece?
  bool is_empty(int column, int row) const {
    const int cell = place(column, row);
    return cell < 0 ||
           starts_[static_cast<std::size_t>(cell)] == starts_[static_cast<std::size_t>(cell) + 1];
  }
  /// 0: the cell has pieces. Else all cells are empty that are fewer columns and fewer rows than
  /// this away.
  int clearance(int column, int row) const {
    const int block = blocks_[block_of(column, row)];
    if (block >= 0) return clearance_[static_cast<std::size_t>(block + within_block(column, row))];
    // All blocks are empty that are fewer columns and fewer rows of blocks than -block away.
    const int i = column & block_mask, k = row & block_mask, least = std::min(i, k),
              most = std::max(i, k);
    return std::min(-block * block_side - most, (-block - 1) * block_side + least + 1);
  }

  /// Follows a line from a point known to `delta` a coordinate. Calls visit(cell) for every cell
  /// with pieces that it may pass and then, from time to time, passed(kappa): of the line until
  /// then every such cell has been visited. Stops where that is true.
  template <class Visit, class Passed>
  void along_line(geometry::Vector point, double delta, geometry::Vector velocity,
                  const Visit& visit, const Passed& passed) const {
    const Course line(point, delta, velocity);
    const CutAxis &along = line.upright ? rows_ : columns_,
                  &across = line.upright ? columns_ : rows_;
    const bool forward = line.speed > 0.0;
    const double reach = 1.1 * delta + 2.0 * geometry::unit_roundoff * std::fabs(line.a0);
    if (forward ? line.a0 - reach > along.high() : line.a0 + reach < along.low()) {
      passed(-HUGE_VAL);
      return;
    }
    const int last = forward ? along.parts() - 1 : 0, step = forward ? 1 : -1;
    // Parts along the way for each part across it.
    const double flatness = along.density() / (std::fabs(line.slope) * across.density());
    bool open = false;  // nothing in the part before
    for (int i = along.part(forward ? line.a0 - reach : line.a0 + reach);; i += step) {
      double end = along.cut(forward ? i + 1 : i);
      const double first = along.cut(forward ? i : i + 1);
      const double begin = forward ? std::max(first, line.a0) : std::min(first, line.a0);
      const int leap = open ? parts_in_clearing(line, along, across, i, begin, flatness) : 0;
      if (leap > 0) {
        i += step * (leap - 1);
        end = along.cut(forward ? i + 1 : i);
      } else {
        open = true;
        const Course::Range b = line.between(begin, end);
        if (b.high >= across.low() && b.low <= across.high()) {
          const int top = across.part(b.high);
          for (int k = across.part(b.low); k <= top; ++k) {
            const int cell = line.upright ? place(k, i) : place(i, k);
            if (cell < 0 || is_empty(cell)) continue;
            open = false;
            visit(cell);
          }
        }
      }
      if (i == last) break;
      // kappa = speed / way: two roundings; the way errs by delta and u.
      const double way = std::fabs(end - line.a0) - reach;
      if (way > 0.0 && passed(std::fabs(line.speed) / way * (1.0 + 8.0 * geometry::unit_roundoff)))
        return;
    }
    passed(-HUGE_VAL);
  }

  /// The same cell by cell, in fewer operations (cell_walk.hpp). False, and nothing is done, where
  /// the line's numbers do not allow it.
  template <class Visit, class Passed>
  bool walk_line(geometry::Vector point, double delta, geometry::Vector velocity,
                 const Visit& visit, const Passed& passed) const;

  /// The same along a Larmor circle, once round. `speed`: |v| to rounding.
  template <class Visit, class Passed>
  void along_circle(geometry::Vector point, double delta, geometry::Vector velocity, double omega,
                    double speed, const Visit& visit, const Passed& passed) const {
    using geometry::Vector;
    const double w = std::fabs(omega), h = 0.5 * w;
    const double bend = 1.01 * w / (4.0 * speed);
    double before = HUGE_VAL, error = delta;
    Vector from = point;
    bool open = false;  // nothing near the stretch before
    for (;;) {
      // On to the next kappa: past a chord as long as a cell, or as the way to the box or through a
      // clearing, or past an eighth of the circle. kappa = h cot(phase), and phases are added.
      // Which numbers these are does not matter, as long as kappa falls and less than half a turn
      // lies between two.
      const Clearing clearing = open ? clearing_at(from) : Clearing{};
      // The arc stays within its chord and c^2 / 4R of where it begins.
      const double clear = 0.99 * clearing.around * narrow_,
                   clear_length = clear * std::max(0.8, 1.0 - clear * bend);
      const double way = std::max(width_, 0.5 * distance(from));
      const bool leap = clear_length > way;
      const double turn = std::max(speed / (leap ? clear_length : way), 2.65 * h);
      const double kappa = before < HUGE_VAL ? (before * turn - h * h) / (before + turn) : turn;
      const bool closing = before < 0.0 && !(before + turn > 0.0 && kappa < before);
      Vector to = point;
      double to_error = delta;
      if (!closing) {
        const Vector d = geometry::displacement(kappa, velocity, omega, 0.5);
        to = point + d;
        to_error = delta + 8.1 * geometry::unit_roundoff * (std::fabs(d.x) + std::fabs(d.y));
      }
      // An arc of at most half a circle of radius R stays within c^2 / 4R of its chord c, and
      // within R. With the ends' errors e, c^2 / 4R grows by at most 3.2 e: c < 0.8 R, and where e
      // > R, R is below e.
      const Vector chord = to - from;
      const double most = 4.4 * std::max(error, to_error) + bend * dot(chord, chord);
      const auto spread = [&](double a, double b) {
        const double grown =
            most + 4.0 * geometry::unit_roundoff * std::max(std::fabs(a), std::fabs(b));
        if (!(grown < HUGE_VAL)) return Course::Range{-HUGE_VAL, HUGE_VAL};
        return Course::Range{std::min(a, b) - grown, std::max(a, b) + grown};
      };
      const Course::Range x = spread(from.x, to.x), y = spread(from.y, to.y);
      if (leap) {
        const int around = clearing.around;
        if (!columns_.within(x.low, x.high, clearing.column - around, clearing.column + around) ||
            !rows_.within(y.low, y.high, clearing.row - around, clearing.row + around)) {
          open = false;  // a shorter stretch
          continue;
        }
      } else {
        open = true;
        visit_box(x, y, [&](int column, int row) {
          const int cell = place(column, row);
          if (cell < 0 || is_empty(cell)) return;
          open = false;
          visit(cell);
        });
      }
      if (closing) break;
      if (passed(kappa)) return;
      before = kappa;
      from = to;
      error = to_error;
    }
    passed(-HUGE_VAL);
  }

 private:
  /// A square of cells without pieces: `around` of them on every side of one.
  struct Clearing {
    int column = 0, row = 0, around = -1;
  };
  Clearing clearing_at(geometry::Vector x) const {
    const int column = columns_.part(x.x), row = rows_.part(x.y);
    return {column, row, clearance(column, row) - 1};
  }
  /// Cells are kept in square blocks, and of these only those that have pieces.
  static constexpr int block_bits = 4, block_side = 1 << block_bits, block_mask = block_side - 1;
  std::size_t block_of(int column, int row) const {
    return static_cast<std::size_t>(column >> block_bits) +
           static_cast<std::size_t>(row >> block_bits) * static_cast<std::size_t>(blocks_in_row_);
  }
  static int within_block(int column, int row) {
    return (column & block_mask) | (row & block_mask) << block_bits;
  }
  /// The index of a cell; negative: it is in a block without pieces.
  int place(int column, int row) const {
    const int block = blocks_[block_of(column, row)];
    return block < 0 ? -1 : block + within_block(column, row);
  }
  bool is_empty(int cell) const {
    return starts_[static_cast<std::size_t>(cell)] == starts_[static_cast<std::size_t>(cell) + 1];
  }
  /// Through how many parts, from part i on, does a line surely stay within the clearing about one
  /// of its cells there? The cells of the line from `begin` to the end of the last of them are
  /// compared with the clearing. Less than two are not worth the question: 0.
  int parts_in_clearing(const Course& line, const CutAxis& along, const CutAxis& across, int i,
                        double begin, double flatness) const {
    const int k = across.part(line.b0 + (begin - line.a0) * line.slope);  // about: any cell will do
    const int around = (line.upright ? clearance(k, i) : clearance(i, k)) - 1;
    if (around < 2) return 0;
    const bool forward = line.speed > 0.0;
    const int most = std::min(around + 1, forward ? along.parts() - i : i + 1);
    const int parts = static_cast<int>(std::min(static_cast<double>(most), around * flatness));
    if (parts < 2) return 0;
    const Course::Range b = line.between(begin, along.cut(forward ? i + parts : i + 1 - parts));
    return across.within(b.low, b.high, k - around, k + around) ? parts : 0;
  }
  /// From a point to the box.
  double distance(geometry::Vector x) const {
    return std::max(
        {0.0, columns_.low() - x.x, x.x - columns_.high(), rows_.low() - x.y, x.y - rows_.high()});
  }
  template <class Visit>
  void visit_box(Course::Range x, Course::Range y, const Visit& visit) const {
    if (!(x.high >= columns_.low() && x.low <= columns_.high() && y.high >= rows_.low() &&
          y.low <= rows_.high()))
      return;
    const int left = columns_.part(x.low), right = columns_.part(x.high), top = rows_.part(y.high);
    for (int k = rows_.part(y.low); k <= top; ++k)
      for (int i = left; i <= right; ++i) visit(i, k);
  }
  struct Reach;
  template <class Visit>
  void cover(const Reach& reach, const Visit& visit) const;
  struct Crowd {
    double entries = 0.0;  ///< of all lists together
    double company = 0.0;  ///< the length of the list that holds an entry, on average
  };
  Crowd cut(const std::vector<Reach>& reaches, const geometry::Box& within, double cells);
  void find_clearances();

  CutAxis columns_, rows_;
  double width_ = 0.0, narrow_ = 0.0;  ///< of a cell, about: the longer side and the shorter
  /// How far beyond a cell a line may be while it is followed as if it were in it: pieces are
  /// listed in each cell that they come near to.
  double slack_ = 0.0;
  int blocks_in_row_ = 0;
  std::vector<int>
      blocks_;  ///< where their cells begin; without pieces: minus the clearance among blocks
  std::vector<std::uint32_t> starts_;
  std::vector<std::uint8_t> clearance_;  ///< of cells in blocks with pieces
  std::vector<int> list_;
};

}  // namespace carom::events
