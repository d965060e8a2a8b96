#include "events/wall_grid.hpp"

#include <variant>

namespace carom {

using geometry::Box;
using geometry::Piece;
using geometry::Segment;
using geometry::unit_roundoff;
using geometry::Vector;

namespace {

/// Cells for each piece: a measured compromise between long lists and many cells.
constexpr double cells_per_piece = 1.0;
/// Entries of lists for each piece, on average: where pieces are long beside the cells, cells are made larger.
constexpr double most_entries = 32.0;

double size(double a, double b) { return std::fmax(std::fabs(a), std::fabs(b)); }

}  // namespace

CutAxis::CutAxis(double low, double high, int parts) {
  cuts_.assign(static_cast<std::size_t>(parts) + 1, low);
  for (int i = 1; i < parts; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(parts);
    cuts_[static_cast<std::size_t>(i)] =
        std::fmin(std::fmax(low + share * (high - low), cuts_[static_cast<std::size_t>(i) - 1]), high);
  }
  cuts_.back() = high;
  inverse_ = high > low ? static_cast<double>(parts) / (high - low) : 0.0;
}

/// A piece as the grid sees it.
struct WallGrid::Reach {
  Box box;                             ///< contains it exactly
  const Segment* segment = nullptr;    ///< or null
  Vector by;                           ///< its displacement …
  double error = 0.0;                  ///< … and the error of each displaced coordinate
};

/// Every cell that a piece may reach into: a segment is followed part by part, others by their boxes.
template <class Visit>
void WallGrid::cover(const Reach& r, const Visit& visit) const {
  const Course::Range x{r.box.low.x, r.box.high.x}, y{r.box.low.y, r.box.high.y};
  if (r.segment == nullptr) return visit_box(x, y, visit);
  if (!(x.high >= columns_.low() && x.low <= columns_.high() && y.high >= rows_.low() && y.low <= rows_.high()))
    return;
  const Course line(r.segment->from + r.by, r.error, r.segment->to - r.segment->from);
  const Course::Range& a = line.upright ? y : x;
  const Course::Range& b = line.upright ? x : y;
  const CutAxis &along = line.upright ? rows_ : columns_, &across = line.upright ? columns_ : rows_;
  const int step_along = line.upright ? columns_.parts() : 1, step_across = line.upright ? 1 : columns_.parts();
  const int end = along.part(a.high);
  for (int i = along.part(a.low); i <= end; ++i) {
    Course::Range here = line.between(std::fmax(along.cut(i), a.low), std::fmin(along.cut(i + 1), a.high));
    here = {std::fmax(here.low, b.low), std::fmin(here.high, b.high)};
    if (!(here.high >= across.low() && here.low <= across.high())) continue;
    const int top = across.part(here.high);
    for (int k = across.part(here.low); k <= top; ++k) visit(i * step_along + k * step_across);
  }
}

WallGrid::WallGrid(const std::vector<Piece>& pieces, Vector first, Vector second, const Box& within) {
  std::vector<Reach> reaches;
  reaches.reserve(pieces.size());
  for (const Piece& p : pieces) {
    Reach r{geometry::bounding_box(p.curve), std::get_if<Segment>(&p.curve), {}, 0.0};
    const double m = static_cast<double>(p.offset.first), n = static_cast<double>(p.offset.second);
    r.by = {m * first.x + n * second.x, m * first.y + n * second.y};
    if (!(p.offset == geometry::Cell{})) {
      // Two products and a sum, the displaced coordinate, and its end.
      const auto rounding = [&](double a, double b, double low, double high) {
        return unit_roundoff * (3.1 * (std::fabs(m * a) + std::fabs(n * b)) + 3.1 * size(low, high));
      };
      const double dx = rounding(first.x, second.x, r.box.low.x, r.box.high.x);
      const double dy = rounding(first.y, second.y, r.box.low.y, r.box.high.y);
      r.box = {{r.box.low.x + r.by.x - dx, r.box.low.y + r.by.y - dy},
               {r.box.high.x + r.by.x + dx, r.box.high.y + r.by.y + dy}};
      r.error = std::fmax(dx, dy);
    }
    // The direction of a segment is rounded as well: 2u of its length.
    if (r.segment != nullptr)
      r.error += 4.0 * unit_roundoff * std::fmax(r.box.high.x - r.box.low.x, r.box.high.y - r.box.low.y);
    reaches.push_back(r);
  }

  const double width = within.high.x - within.low.x, height = within.high.y - within.low.y;
  double cells = std::fmax(1.0, cells_per_piece * static_cast<double>(pieces.size()));
  for (;;) {
    // Cells about as wide as high; a box without extent has one row or column.
    const auto parts = [&](double here, double there) {
      const double count = there > 0.0 ? std::sqrt(cells * here / there) : cells;
      return static_cast<int>(std::fmin(std::fmax(std::ceil(count), 1.0), std::fmin(cells, 30000.0)));
    };
    columns_ = CutAxis(within.low.x, within.high.x, parts(width, height));
    rows_ = CutAxis(within.low.y, within.high.y, parts(height, width));
    width_ = std::fmax(width / columns_.parts(), height / rows_.parts());
    const std::size_t total = static_cast<std::size_t>(columns_.parts()) * static_cast<std::size_t>(rows_.parts());
    starts_.assign(total + 1, 0);
    std::size_t entries = 0;
    const std::size_t most = 1024 + static_cast<std::size_t>(most_entries * static_cast<double>(pieces.size()));
    for (const Reach& r : reaches) {
      cover(r, [&](int cell) {
        ++entries;
        ++starts_[static_cast<std::size_t>(cell) + 1];
      });
      if (entries > most && cells > 1.0) break;
    }
    if (entries <= most || cells <= 1.0) break;
    cells = std::fmax(1.0, std::floor(0.5 * cells));
  }
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  list_.resize(starts_.back());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t p = 0; p < reaches.size(); ++p)
    cover(reaches[p], [&](int cell) { list_[next[static_cast<std::size_t>(cell)]++] = static_cast<int>(p); });
}

}  // namespace carom
