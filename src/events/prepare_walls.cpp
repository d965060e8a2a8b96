// Makes a table ready for flights: pieces, images of walls that reach into the cell, cell edges.
#include <algorithm>
#include <cmath>

#include "events/next_hit.hpp"

namespace carom {

using namespace geometry;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

HitFinder::HitFinder(const Table& table, DecisionOptions options, bool edges, bool complement)
    : table_(table), options_(options) {
  for (const Wall& wall : table.walls) curves_.emplace_back(complement ? reversed(wall.curve) : wall.curve);
  for (const Wall& wall : table.walls)
    end_normals_.push_back(is_closed(wall.curve) ? Vector{} : normal_at(wall.curve, end_parameter(wall.curve)));
  for (const Wall& wall : table.walls) holed_.push_back(wall.holes.empty() ? 0 : 1);
  cells_ = table.lattice.has_value();
  offsets_.push_back({});
  add_walls({}, complement);
  if (table.lattice) {
    for (const Cell& offset : image_offsets()) {
      offsets_.push_back(offset);
      add_walls(offset, complement);
    }
  }
  displaced_ = offsets_.size() > 1;
  first_edge_ = static_cast<int>(data_.size());
  if (table.lattice && edges) {
    const auto& cell = table.lattice->edges;
    for (std::size_t i = 0; i < cell.size(); ++i) {
      const int curve = static_cast<int>(curves_.size());
      curves_.emplace_back(cell[i].segment);
      const int next = first_edge_ + static_cast<int>((i + 1) % cell.size());
      data_.push_back({nullptr, curve, -1, 0, next, true, false, CurveKind::segment});
      joints_.push_back(cell[i].segment.from);
      open_.push_back(static_cast<int>(data_.size()) - 1);
      pieces_.push_back({cell[i].segment, {}, next, true});
      for (std::size_t k = 0; k < cell.size(); ++k)
        if (cell[k].beyond == Cell{-cell[i].beyond.first, -cell[i].beyond.second})
          opposite_.push_back(first_edge_ + static_cast<int>(k));
    }
  }
  for (int i = 0; i < static_cast<int>(data_.size()); ++i) all_.push_back(i);
  const Vector none{0.0, 0.0};
  exact_ = std::make_unique<ExactBoundary>(pieces_, table.lattice ? table.lattice->first : none,
                                           table.lattice ? table.lattice->second : none);
  for (const PreparedCurve& c : curves_)
    reach_ = std::max(reach_, 1.01 * (std::fabs(c.from.x) + std::fabs(c.from.y)));
  for (PieceData& p : data_) p.shape = &curves_[at(p.curve)];  // curves_ is complete
  origins_.resize(offsets_.size());
  left_.resize(data_.size());
  if (edges) find_enclosure(complement);
}

HitFinder::~HitFinder() = default;

void HitFinder::add_walls(Cell offset, bool complement) {
  const int base = static_cast<int>(data_.size());
  const int index = static_cast<int>(offsets_.size()) - 1;
  for (std::size_t i = 0; i < table_.walls.size(); ++i) {
    const Wall& wall = table_.walls[i];
    const Curve curve = complement ? reversed(wall.curve) : wall.curve;
    const int next = base + (complement ? wall.previous : wall.next);
    data_.push_back({nullptr, static_cast<int>(i), static_cast<int>(i), index, next, false, curves_[i].closed, curves_[i].kind});
    joints_.push_back(curves_[i].from);
    if (!curves_[i].closed) open_.push_back(static_cast<int>(data_.size()) - 1);
    pieces_.push_back({curve, offset, next, false});
  }
}

/// Lattice vectors by which the walls, displaced, may reach into the cell. A vector too many costs time,
/// one too few would lose walls: so boxes are compared, and circles by their distance from the edges,
/// with the rounding of this comparison on the safe side.
std::vector<Cell> HitFinder::image_offsets() const {
  const Lattice& lattice = *table_.lattice;
  double cell_size = 0.0, wall_size = 0.0;
  for (const CellEdge& e : lattice.edges)
    cell_size = std::max(cell_size, std::sqrt(dot(e.segment.from, e.segment.from)));
  for (const PreparedCurve& c : curves_) wall_size = std::max(wall_size, 2.0 * c.extent);
  const double area = lattice.cell_area();
  const double longest = std::sqrt(std::max(dot(lattice.first, lattice.first), dot(lattice.second, lattice.second)));
  // |m a + n b| >= max(|m|, |n|) area / longest: beyond this no wall reaches the cell.
  const int range = static_cast<int>(std::ceil((cell_size + wall_size) * longest / area)) + 1;
  std::vector<Cell> found;
  for (int m = -range; m <= range; ++m)
    for (int n = -range; n <= range; ++n) {
      if (m == 0 && n == 0) continue;
      const Vector t = lattice.translation({m, n});
      bool reaches = false;
      for (std::size_t i = 0; i < table_.walls.size() && !reaches; ++i) {
        const PreparedCurve& c = curves_[i];
        const Box box = bounding_box(table_.walls[i].curve);
        bool outside = false;
        for (const CellEdge& e : lattice.edges) {
          const Vector d = e.segment.to - e.segment.from;
          const double length = std::sqrt(dot(d, d));
          // Largest signed distance of the wall from the edge's line, inside positive.
          double reach = 0.0;
          if (c.kind == CurveKind::circle) {
            reach = geometry::cross(d, c.centre + t - e.segment.from) / length + std::sqrt(c.r2);
          } else {
            reach = -HUGE_VAL;
            for (const Vector& corner : {box.low, box.high, Vector{box.low.x, box.high.y}, Vector{box.high.x, box.low.y}})
              reach = std::max(reach, geometry::cross(d, corner + t - e.segment.from) / length);
          }
          const double size = std::fabs(t.x) + std::fabs(t.y) + 2.0 * c.extent + 2.0 * cell_size;
          if (reach < -32.0 * unit_roundoff * size) outside = true;
        }
        reaches = !outside;
      }
      if (reaches) found.push_back({m, n});
    }
  return found;
}

/// The edge that the flight crosses without moving: its start lies beyond it, or on it and on its way
/// out. The tie rule is that of the joints: a point on the flight counts as lying on its left.
int HitFinder::edge_crossed_at_start(const Flight& f) const {
  for (int i = first_edge_; i < static_cast<int>(data_.size()); ++i) {
    const PreparedCurve& w = curves_[at(data_[at(i)].curve)];
    const Vector e = origins_[0].point - w.from;
    const double side = geometry::cross(w.tangent, e);
    const double bound = line_error(origins_[0].scale, std::fabs(e.x) + std::fabs(e.y)).a;
    Sign sign = sign_within(side, bound);
    if (sign == Sign::undecided) sign = exact_flight(f).left_of(i, f.cell);
    if (sign == Sign::positive) continue;
    if (sign == Sign::negative) return i;
    Sign out = exact_->inward(i, 0.0, f.velocity);
    if (out == Sign::zero) {
      const bool along = dot(w.direction, f.velocity) > 0;  // parallel: the sign is certain
      out = (f.omega == 0.0 ? along : (f.omega > 0) == along) ? Sign::negative : Sign::positive;
    }
    if (out == Sign::negative) return i;
  }
  return -1;
}

/// The piece the particle stands on, seen from the flight's cell.
void HitFinder::find_start(Flight& f) const {
  f.start_piece = f.wall;  // the pieces begin with the walls in their own cell
  f.start_previous = -1;
  if (f.wall < 0) return;
  if (!(f.cell == Cell{})) {
    f.start_piece = -1;
    for (std::size_t i = 0; i < data_.size(); ++i) {
      const Cell o = offsets_[at(data_[i].offset)];
      if (data_[i].wall == f.wall && o.first == -f.cell.first && o.second == -f.cell.second)
        f.start_piece = static_cast<int>(i);
    }
  }
  if (f.u != 0.0 || f.start_piece < 0 || curves_[at(f.wall)].closed) return;
  for (std::size_t i = 0; i < data_.size(); ++i)
    if (data_[i].next == f.start_piece && static_cast<int>(i) != f.start_piece)
      f.start_previous = static_cast<int>(i);
}

void HitFinder::begin(Flight& f) const {
  f.entry = -1;
  if (table_.lattice && first_edge_ < static_cast<int>(data_.size())) {
    for (;;) {
      look_from(f);
      const int edge = edge_crossed_at_start(f);
      if (edge < 0) break;
      const Cell beyond = table_.lattice->edges[at(edge - first_edge_)].beyond;
      f.cell.first += beyond.first;
      f.cell.second += beyond.second;
    }
  }
  find_start(f);
}

bool HitFinder::in_cell(const Flight& f) const {
  look_from(f);
  return edge_crossed_at_start(f) < 0;
}

void HitFinder::cross(Flight& f, const Ahead& ahead) const {
  const auto& edges = table_.lattice->edges;
  const Cell beyond = edges[at(ahead.piece - first_edge_)].beyond;
  f.cell.first += beyond.first;
  f.cell.second += beyond.second;
  f.entry = opposite_[at(ahead.piece - first_edge_)];
  find_start(f);
}

}  // namespace carom
