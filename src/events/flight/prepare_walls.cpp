// Makes a table ready for flights: pieces, images of walls that reach into the cell, cell edges.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/geometry/hull.hpp"
#include "carom/geometry/lattice_copies.hpp"
#include "events/flight/next_hit.hpp"

namespace carom {

using namespace geometry;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

HitFinder::HitFinder(const Table& table, DecisionOptions options, bool edges, bool complement)
    : table_(table), options_(options) {
  for (const Wall& wall : table.walls)
    curves_.emplace_back(complement ? reversed(wall.curve) : wall.curve);
  for (const Wall& wall : table.walls)
    end_normals_.push_back(
        is_closed(wall.curve) ? Vector{} : normal_at(wall.curve, end_parameter(wall.curve)));
  for (const Wall& wall : table.walls) holed_.push_back(wall.holes.empty() ? 0 : 1);
  cells_ = table.lattice.has_value();
  offsets_.push_back({});
  add_walls({}, complement, {});
  if (table.lattice) {
    for (const Images& one : images()) {
      offsets_.push_back(one.offset);
      add_walls(one.offset, complement, one.loops);
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
      const int previous = first_edge_ + static_cast<int>((i + cell.size() - 1) % cell.size());
      data_.push_back({nullptr, curve, -1, 0, next, previous, true, false, CurveKind::segment});
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
  find_ellipses();
  for (const PreparedCurve& c : curves_)
    reach_ = std::max(reach_, 1.01 * (std::fabs(c.from.x) + std::fabs(c.from.y)));
  for (PieceData& p : data_) p.shape = &curves_[at(p.curve)];  // curves_ is complete
  origins_.resize(offsets_.size());
  left_.resize(data_.size());
  if (edges) find_enclosure(complement);
  if (static_cast<int>(data_.size()) >= options_.grid_from) make_grid(edges);
}

HitFinder::~HitFinder() = default;

/// Which elliptic arcs are of one ellipse: who stands on one stands on the ellipse of all.
void HitFinder::find_ellipses() {
  std::map<std::array<double, 7>, std::vector<int>>
      alike;  // by numbers, rounded: the first arc of each ellipse
  for (int i = 0; i < static_cast<int>(table_.walls.size()); ++i) {
    const PreparedCurve& w = curves_[at(i)];
    if (w.kind != CurveKind::ellipse || w.closed) continue;
    std::vector<int>& others = alike[{w.orientation, w.centre.x, w.centre.y, w.first_axis.x,
                                      w.first_axis.y, w.second_axis.x, w.second_axis.y}];
    const auto same = std::find_if(others.begin(), others.end(),
                                   [&](int other) { return exact_->same_ellipse(other, i); });
    data_[at(i)].ellipse = same == others.end() ? i : *same;
    if (same == others.end()) others.push_back(i);
  }
  for (PieceData& p : data_)
    if (p.wall >= 0) p.ellipse = data_[at(p.wall)].ellipse;
}

/// Pieces of the walls displaced by an offset; all of them in their own cell, where piece and wall
/// have one number, else the loops that `loops` names.
void HitFinder::add_walls(Cell offset, bool complement, const std::vector<int>& loops) {
  const int index = static_cast<int>(offsets_.size()) - 1;
  const auto add = [&](int i, int piece_of_next, int piece_of_previous) {
    const Wall& wall = table_.walls[at(i)];
    const PreparedCurve& c = curves_[at(i)];
    const int next = complement ? piece_of_previous : piece_of_next;
    const int previous = complement ? piece_of_next : piece_of_previous;
    if (index > 0) images_.emplace(i, static_cast<int>(data_.size()));
    data_.push_back({nullptr, i, i, index, next, previous, false, c.closed, c.kind});
    joints_.push_back(c.from);
    if (!c.closed) open_.push_back(static_cast<int>(data_.size()) - 1);
    pieces_.push_back({complement ? reversed(wall.curve) : wall.curve, offset, next, false});
  };
  if (index == 0) {
    for (int i = 0; i < static_cast<int>(table_.walls.size()); ++i)
      add(i, table_.walls[at(i)].next, table_.walls[at(i)].previous);
    return;
  }
  for (const int first : loops) {
    // The walls of a loop, one after the other.
    const int base = static_cast<int>(data_.size());
    int count = 0;
    for (int i = first; count == 0 || i != first; i = table_.walls[at(i)].next) ++count;
    int k = 0;
    for (int i = first; k < count; i = table_.walls[at(i)].next, ++k)
      add(i, base + (k + 1) % count, base + (k + count - 1) % count);
  }
}

/// The loops of walls that, displaced by a lattice vector, may reach into the cell, by that vector.
/// A loop too many costs time, one too few would lose walls: so boxes are compared, and circles by
/// their distance from the edges, with the rounding of this comparison on the safe side.
std::vector<HitFinder::Images> HitFinder::images() const {
  const Lattice& lattice = *table_.lattice;
  double cell_size = 0.0;
  for (const CellEdge& e : lattice.edges)
    cell_size = std::max(cell_size, std::sqrt(dot(e.segment.from, e.segment.from)));
  struct Edge {
    Vector from, direction;
    double length;
  };
  std::vector<Edge> edges;
  for (const CellEdge& e : lattice.edges) {
    const Vector d = e.segment.to - e.segment.from;
    edges.push_back({e.segment.from, d, std::sqrt(dot(d, d))});
  }
  /// Largest signed distance of a box, displaced, from an edge's line, inside positive.
  const auto reach_of = [](const Box& box, Vector t, const Edge& e) {
    double reach = -HUGE_VAL;
    for (const Vector& corner :
         {box.low, box.high, Vector{box.low.x, box.high.y}, Vector{box.high.x, box.low.y}})
      reach = std::max(reach, geometry::cross(e.direction, corner + t - e.from) / e.length);
    return reach;
  };
  const auto outside = [&](const Box& box, double extent, Vector t) {
    const double size = std::fabs(t.x) + std::fabs(t.y) + 2.0 * extent + 2.0 * cell_size;
    for (const Edge& e : edges)
      if (reach_of(box, t, e) < -32.0 * unit_roundoff * size) return true;
    return false;
  };
  const auto circle_outside = [&](const PreparedCurve& c, Vector t) {
    const double size = std::fabs(t.x) + std::fabs(t.y) + 2.0 * c.extent + 2.0 * cell_size;
    for (const Edge& e : edges)
      if (geometry::cross(e.direction, c.centre + t - e.from) / e.length + std::sqrt(c.r2) <
          -32.0 * unit_roundoff * size)
        return true;
    return false;
  };

  std::vector<Images> found;
  if (table_.walls.empty()) return found;
  std::vector<Box> boxes;
  for (const Wall& wall : table_.walls) boxes.push_back(bounding_box(wall.curve));
  double wall_size = 0.0;
  for (const PreparedCurve& c : curves_) wall_size = std::max(wall_size, 2.0 * c.extent);
  const Box whole = hull_of(boxes);
  const Box cell = hull_of(lattice.edges, [](const CellEdge& e) {
    return Box{e.segment.from, e.segment.from};
  });
  constexpr std::size_t most = 65536;
  const auto copies = cells_that_reach(lattice, whole, cell, most);
  if (!copies)
    throw InputError("copies of the walls and supports from more than " + std::to_string(most) +
                     " cells of the lattice reach into one: the table is too wide for its lattice");
  for (const Cell& cell_of_copy : *copies) {
    if (cell_of_copy == Cell{}) continue;
    const Vector t = displacement(lattice, cell_of_copy);
    if (outside(whole, 0.5 * wall_size, t)) continue;
    Images images{cell_of_copy, {}};
    std::vector<bool> done(table_.walls.size(), false);
    for (std::size_t first = 0; first < table_.walls.size(); ++first) {
      if (done[first]) continue;
      bool reaches = false;
      for (std::size_t i = first; !done[i]; i = at(table_.walls[i].next)) {
        done[i] = true;
        const PreparedCurve& c = curves_[i];
        if (reaches) continue;
        reaches =
            c.kind == CurveKind::circle ? !circle_outside(c, t) : !outside(boxes[i], c.extent, t);
      }
      if (reaches) images.loops.push_back(static_cast<int>(first));
    }
    if (!images.loops.empty()) found.push_back(std::move(images));
  }
  return found;
}

/// The edge that the flight crosses without moving: its start lies beyond it, or on it and on its
/// way out. The tie rule is that of the joints: a point on the flight counts as lying on its left.
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
    const auto [first, end] = images_.equal_range(f.wall);
    for (auto image = first; image != end; ++image) {
      const Cell o = offsets_[at(data_[at(image->second)].offset)];
      if (o.first == -f.cell.first && o.second == -f.cell.second) f.start_piece = image->second;
    }
  }
  if (f.u != 0.0 || f.start_piece < 0 || curves_[at(f.wall)].closed) return;
  f.start_previous = data_[at(f.start_piece)].previous;
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
