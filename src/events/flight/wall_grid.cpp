#include "events/flight/wall_grid.hpp"

#include <variant>

namespace carom::events {

using geometry::Box;
using geometry::Piece;
using geometry::Segment;
using geometry::unit_roundoff;
using geometry::Vector;

namespace {

/// Cells for each piece: a measured compromise between long lists and many cells.
constexpr double cells_per_piece = 1.0;
/// Where lists are longer than this for an entry on average, cells are cut in four, as pieces short
/// beside them and side by side, those of a polygon, ask for. So many entries and blocks for each
/// piece at most.
constexpr double most_company = 8.0, entries_when_fine = 4.0, blocks_when_fine = 4.0;
/// Entries of lists for each piece, on average: where pieces are long beside the cells, cells are
/// made larger.
constexpr double most_entries = 32.0;

double size(double a, double b) { return std::fmax(std::fabs(a), std::fabs(b)); }

}  // namespace

CutAxis::CutAxis(double low, double high, int parts) {
  cuts_.assign(static_cast<std::size_t>(parts) + 1, low);
  for (int i = 1; i < parts; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(parts);
    cuts_[static_cast<std::size_t>(i)] = std::fmin(
        std::fmax(low + share * (high - low), cuts_[static_cast<std::size_t>(i) - 1]), high);
  }
  cuts_.back() = high;
  inverse_ = high > low ? static_cast<double>(parts) / (high - low) : 0.0;
}

/// A piece as the grid sees it.
struct WallGrid::Reach {
  Box box;                           ///< contains it exactly
  const Segment* segment = nullptr;  ///< or null
  Vector by;                         ///< its displacement …
  double error = 0.0;                ///< … and the error of each displaced coordinate
};

/// Every cell that a piece may reach into: a segment is followed part by part, others by their
/// boxes.
template <class Visit>
void WallGrid::cover(const Reach& r, const Visit& visit) const {
  const Course::Range x{r.box.low.x, r.box.high.x}, y{r.box.low.y, r.box.high.y};
  if (r.segment == nullptr) return visit_box(x, y, visit);
  if (!(x.high >= columns_.low() && x.low <= columns_.high() && y.high >= rows_.low() &&
        y.low <= rows_.high()))
    return;
  const Course line(r.segment->from + r.by, r.error, r.segment->to - r.segment->from);
  const Course::Range& a = line.upright ? y : x;
  const Course::Range& b = line.upright ? x : y;
  const CutAxis &along = line.upright ? rows_ : columns_, &across = line.upright ? columns_ : rows_;
  const int end = along.part(a.high);
  for (int i = along.part(a.low); i <= end; ++i) {
    Course::Range here =
        line.between(std::fmax(along.cut(i), a.low), std::fmin(along.cut(i + 1), a.high));
    here = {std::fmax(here.low, b.low), std::fmin(here.high, b.high)};
    if (!(here.high >= across.low() && here.low <= across.high())) continue;
    const int top = across.part(here.high);
    for (int k = across.part(here.low); k <= top; ++k) line.upright ? visit(k, i) : visit(i, k);
  }
}

WallGrid::WallGrid(const std::vector<Piece>& pieces, Vector first, Vector second,
                   const Box& within) {
  // Cells are as if they were larger by this, which is little beside them, on each side.
  const double extent = size(size(within.low.x, within.high.x), size(within.low.y, within.high.y));
  const double margin = 0x1p-30 * (within.high.x - within.low.x + within.high.y - within.low.y) +
                        256.0 * unit_roundoff * extent;
  slack_ = margin - 24.0 * unit_roundoff * extent;
  std::vector<Reach> reaches;
  reaches.reserve(pieces.size());
  for (const Piece& p : pieces) {
    Reach r{geometry::bounding_box(p.curve), std::get_if<Segment>(&p.curve), {}, 0.0};
    const double m = static_cast<double>(p.offset.first), n = static_cast<double>(p.offset.second);
    r.by = {m * first.x + n * second.x, m * first.y + n * second.y};
    if (!(p.offset == geometry::Cell{})) {
      // Two products and a sum, the displaced coordinate, and its end.
      const auto rounding = [&](double a, double b, double low, double high) {
        return unit_roundoff *
               (3.1 * (std::fabs(m * a) + std::fabs(n * b)) + 3.1 * size(low, high));
      };
      const double dx = rounding(first.x, second.x, r.box.low.x, r.box.high.x);
      const double dy = rounding(first.y, second.y, r.box.low.y, r.box.high.y);
      r.box = {{r.box.low.x + r.by.x - dx, r.box.low.y + r.by.y - dy},
               {r.box.high.x + r.by.x + dx, r.box.high.y + r.by.y + dy}};
      r.error = std::fmax(dx, dy);
    }
    // The direction of a segment is rounded as well: 2u of its length.
    if (r.segment != nullptr)
      r.error +=
          4.0 * unit_roundoff * std::fmax(r.box.high.x - r.box.low.x, r.box.high.y - r.box.low.y);
    r.error += margin;
    r.box = {r.box.low - Vector{margin, margin}, r.box.high + Vector{margin, margin}};
    reaches.push_back(r);
  }

  const double count = static_cast<double>(pieces.size());
  double cells = std::fmax(1.0, cells_per_piece * count);
  Crowd crowd = cut(reaches, within, cells);
  while (crowd.entries > 1024.0 + most_entries * count && cells > 1.0) {
    cells = std::fmax(1.0, std::floor(0.5 * cells));
    crowd = cut(reaches, within, cells);
  }
  while (crowd.company > most_company &&
         4.0 * cells <= block_side * block_side * blocks_when_fine * count) {
    const Crowd finer = cut(reaches, within, 4.0 * cells);
    if (finer.entries > entries_when_fine * count || finer.company > 0.75 * crowd.company) {
      cut(reaches, within, cells);  // no better: as before
      break;
    }
    cells *= 4.0;
    crowd = finer;
  }
  for (std::size_t i = 1; i < starts_.size(); ++i)
    starts_[i] = starts_[i - 1] + (starts_[i] + 1) / 2 * 2;
  list_.resize(starts_.back(), -1);
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t p = 0; p < reaches.size(); ++p)
    cover(reaches[p], [&](int i, int k) {
      list_[next[static_cast<std::size_t>(place(i, k))]++] = static_cast<int>(p);
    });
  for (std::size_t i = 1; i < list_.size(); i += 2)
    if (list_[i] < 0) list_[i] = list_[i - 1];
  find_clearances();
}

/// Cuts the box into about this many cells and counts the entries of each.
WallGrid::Crowd WallGrid::cut(const std::vector<Reach>& reaches, const Box& within, double cells) {
  const double width = within.high.x - within.low.x, height = within.high.y - within.low.y;
  // Cells about as wide as high; a box without extent has one row or column.
  const auto parts = [&](double here, double there) {
    const double count = there > 0.0 ? std::sqrt(cells * here / there) : cells;
    return static_cast<int>(std::fmin(std::fmax(std::ceil(count), 1.0), std::fmin(cells, 30000.0)));
  };
  columns_ = CutAxis(within.low.x, within.high.x, parts(width, height));
  rows_ = CutAxis(within.low.y, within.high.y, parts(height, width));
  width_ = std::fmax(width / columns_.parts(), height / rows_.parts());
  narrow_ = std::fmin(width / columns_.parts(), height / rows_.parts());
  blocks_in_row_ = (columns_.parts() - 1) / block_side + 1;
  blocks_.assign(block_of(columns_.parts() - 1, rows_.parts() - 1) + 1, -1);
  Crowd crowd;
  for (const Reach& r : reaches) {
    cover(r, [&](int i, int k) {
      blocks_[block_of(i, k)] = 0;
      crowd.entries += 1.0;
    });
    if (crowd.entries > 1024.0 + most_entries * static_cast<double>(reaches.size()) && cells > 1.0)
      return crowd;
  }
  int kept = 0;
  for (int& block : blocks_)
    if (block == 0) block = block_side * block_side * kept++;
  starts_.assign(static_cast<std::size_t>(block_side * block_side * kept) + 1, 0);
  for (const Reach& r : reaches)
    cover(r, [&](int i, int k) { ++starts_[static_cast<std::size_t>(place(i, k)) + 1]; });
  for (const std::uint32_t pieces : starts_)
    crowd.company +=
        static_cast<double>(pieces) * static_cast<double>(pieces) / std::fmax(crowd.entries, 1.0);
  return crowd;
}

namespace {

/// Distances to the nearest zero, by the larger of the steps along rows and columns, in a square
/// array. Two sweeps, each adding 1 to the least of the four neighbours that it has passed: a
/// shortest way from one cell to another is of steps of the first sweep and then of the second,
/// within the rectangle of both.
void sweep(std::vector<int>& distance, int columns, int rows) {
  const auto of = [&](int i, int k) -> int& {
    return distance[static_cast<std::size_t>(i) +
                    static_cast<std::size_t>(columns) * static_cast<std::size_t>(k)];
  };
  const auto lower = [&](int i, int k, int from_i, int from_k) {
    if (from_i >= 0 && from_i < columns && from_k >= 0 && from_k < rows)
      of(i, k) = std::min(of(i, k), of(from_i, from_k) + 1);
  };
  for (int k = 0; k < rows; ++k)
    for (int i = 0; i < columns; ++i) {
      lower(i, k, i - 1, k);
      for (int side = -1; side <= 1; ++side) lower(i, k, i + side, k - 1);
    }
  for (int k = rows - 1; k >= 0; --k)
    for (int i = columns - 1; i >= 0; --i) {
      lower(i, k, i + 1, k);
      for (int side = -1; side <= 1; ++side) lower(i, k, i + side, k + 1);
    }
}

}  // namespace

/// Among blocks, and then in each that has pieces: there the nearest cell with pieces is less than
/// a block away, in the same block or in one of its eight neighbours.
void WallGrid::find_clearances() {
  const int columns = blocks_in_row_, rows = static_cast<int>(blocks_.size()) / columns;
  std::vector<int> distance(blocks_.size());
  const int far = columns + rows;
  for (std::size_t b = 0; b < blocks_.size(); ++b) distance[b] = blocks_[b] < 0 ? far : 0;
  sweep(distance, columns, rows);
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (blocks_[b] < 0) blocks_[b] = -distance[b];

  clearance_.assign(starts_.size() - 1, 0);
  constexpr int side = 3 * block_side;
  std::vector<int> around(side * side);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (blocks_[b] < 0) continue;
    const int first = (static_cast<int>(b) % columns - 1) * block_side,
              low = (static_cast<int>(b) / columns - 1) * block_side;
    for (int k = 0; k < side; ++k)
      for (int i = 0; i < side; ++i) {
        const int column = first + i, row = low + k;
        const bool is_cell =
            column >= 0 && column < columns_.parts() && row >= 0 && row < rows_.parts();
        around[static_cast<std::size_t>(i + side * k)] =
            is_cell && !is_empty(column, row) ? 0 : side;
      }
    sweep(around, side, side);
    for (int k = 0; k < block_side; ++k)
      for (int i = 0; i < block_side; ++i)
        clearance_[static_cast<std::size_t>(blocks_[b] + within_block(i, k))] =
            static_cast<std::uint8_t>(
                around[static_cast<std::size_t>(block_side + i + side * (block_side + k))]);
  }
}

}  // namespace carom::events
