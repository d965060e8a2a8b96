// Makes a table ready for flights: pieces, images of walls that reach into the cell, cell edges.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "carom/base/error.hpp"
#include "carom/geometry/hull.hpp"
#include "carom/geometry/lattice_copies.hpp"
#include "events/flight/chain_tree.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/piece_table.hpp"
#include "table/loops.hpp"
#include "table/thin_walls.hpp"

namespace carom::events {

using namespace geometry;

namespace {

using base::at;

}  // namespace

/// Fills in a table and what its copies share.
class PieceTable::Preparation : public PieceTable::Shared {
 public:
  Preparation(PieceTable& table_made, bool edges, bool complement);

 private:
  /// Loops of walls, each named by one of its walls, that reach into the cell displaced by
  /// `offset`.
  struct Images {
    Cell offset;
    std::vector<int> loops;
  };
  void add_walls(Cell offset, bool complement, const std::vector<int>& loops);
  void add_edges();
  std::vector<Images> loops_that_reach() const;
  void find_ellipses();
  void find_enclosure(bool complement);
  void find_signs(bool complement);
  void find_within();
  void make_grid(bool edges);
  void list_near(Vector first, Vector second);
  bool has_long_loops() const;

  PieceTable& made_;
  const Table& table_;
  std::vector<Piece> pieces_;  // as `data`, for the exact stage
};

PieceTable::PieceTable(const Table& the_table, DecisionOptions how, bool edges, bool complement)
    : table(the_table), options(how), cells(the_table.lattice.has_value()) {
  Preparation prepared(*this, edges, complement);
  shared_ = std::make_shared<const Shared>(std::move(static_cast<Shared&>(prepared)));
  curves = shared_->curves;
  data = shared_->data;
  joints = shared_->joints;
  open = shared_->open;
  offsets = shared_->offsets;
  discs = shared_->discs;
  near = shared_->near;
  exact = shared_->exact.get();
  grid = shared_->grid.get();
  tree = shared_->tree.get();
}

PieceTable::Preparation::Preparation(PieceTable& table_made, bool edges, bool complement)
    : made_(table_made), table_(table_made.table) {
  const table::FlightSizes sizes = table::flight_sizes(table_);
  for (const Wall& wall : table_.walls) {
    const bool closed = is_closed(wall.curve);
    curves.emplace_back(complement ? reversed(wall.curve) : wall.curve);
    if (sizes.is_thin(curves.back().parametrisation)) {
      curves.back().make_thin();
      made_.thin = true;
    }
    end_normals.push_back(closed ? Vector{} : normal_at(wall.curve, end_parameter(wall.curve)));
  }
  offsets.push_back({});
  add_walls({}, complement, {});
  if (made_.cells) {
    for (const Images& one : loops_that_reach()) {
      offsets.push_back(one.offset);
      add_walls(one.offset, complement, one.loops);
    }
  }
  made_.displaced = offsets.size() > 1;
  made_.first_edge = static_cast<int>(data.size());
  if (made_.cells && edges) add_edges();
  for (int i = 0; i < static_cast<int>(data.size()); ++i) all.push_back(i);
  const Vector none{0.0, 0.0};
  exact = std::make_unique<const ExactBoundary>(pieces_, made_.cells ? table_.lattice->first : none,
                                                made_.cells ? table_.lattice->second : none);
  find_ellipses();
  for (const PreparedCurve& c : curves) made_.reach = std::max(made_.reach, 1.01 * norm_1(c.from));
  for (PieceData& p : data) p.shape = &curves[at(p.curve)];  // curves is complete
  if (made_.cells && edges) find_within();
  if (edges) {
    find_enclosure(complement);
    find_signs(complement);
  }
  if (static_cast<int>(data.size()) < made_.options.grid_from) return;
  make_grid(edges);
  if (!made_.cells && has_long_loops()) {
    std::vector<Curve> in_order;
    for (const Piece& p : pieces_) in_order.push_back(p.curve);
    tree = std::make_unique<const ChainTree>(in_order);
  }
}

void PieceTable::Preparation::add_edges() {
  const auto& edges = table_.lattice->edges;
  const std::size_t count = edges.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int curve = static_cast<int>(curves.size());
    curves.emplace_back(edges[i].segment);
    const int next = made_.first_edge + static_cast<int>((i + 1) % count);
    const int previous = made_.first_edge + static_cast<int>((i + count - 1) % count);
    open.push_back(static_cast<int>(data.size()));
    data.push_back({nullptr, curve, -1, 0, next, previous, true, false, CurveKind::segment});
    joints.push_back(edges[i].segment.from);
    pieces_.push_back({edges[i].segment, {}, next, true});
    for (std::size_t k = 0; k < count; ++k)
      if (edges[k].beyond == Cell{-edges[i].beyond.first, -edges[i].beyond.second})
        opposite.push_back(made_.first_edge + static_cast<int>(k));
  }
}

/// Finds which elliptic arcs are of one ellipse: a particle on one of them is on the ellipse of
/// all.
void PieceTable::Preparation::find_ellipses() {
  // The first arc of each ellipse, by its rounded numbers.
  std::map<std::array<double, 7>, std::vector<int>> alike;
  for (int i = 0; i < static_cast<int>(table_.walls.size()); ++i) {
    const PreparedCurve& w = curves[at(i)];
    if (w.kind != CurveKind::ellipse || w.closed) continue;
    std::vector<int>& others = alike[{w.orientation, w.centre.x, w.centre.y, w.first_axis.x,
                                      w.first_axis.y, w.second_axis.x, w.second_axis.y}];
    const auto same = std::find_if(others.begin(), others.end(),
                                   [&](int other) { return exact->same_ellipse(other, i); });
    data[at(i)].ellipse = same == others.end() ? i : *same;
    if (same == others.end()) others.push_back(i);
  }
  for (PieceData& p : data)
    if (p.wall >= 0) p.ellipse = data[at(p.wall)].ellipse;
}

/// Pieces of the walls made_.displaced by an offset; all of them in their own cell, where piece and
/// wall have one number, else the loops that `loops` names.
void PieceTable::Preparation::add_walls(Cell offset, bool complement,
                                        const std::vector<int>& loops) {
  const int index = static_cast<int>(offsets.size()) - 1;
  const auto add = [&](int i, int piece_of_next, int piece_of_previous) {
    const Wall& wall = table_.walls[at(i)];
    const PreparedCurve& c = curves[at(i)];
    const int next = complement ? piece_of_previous : piece_of_next;
    const int previous = complement ? piece_of_next : piece_of_previous;
    if (index > 0) images.emplace(i, static_cast<int>(data.size()));
    data.push_back({nullptr, i, i, index, next, previous, false, c.closed, c.kind, false,
                    !wall.holes.empty()});
    joints.push_back(c.from);
    if (!c.closed) open.push_back(static_cast<int>(data.size()) - 1);
    pieces_.push_back({complement ? reversed(wall.curve) : wall.curve, offset, next, false});
  };
  if (index == 0) {
    for (int i = 0; i < static_cast<int>(table_.walls.size()); ++i)
      add(i, table_.walls[at(i)].next, table_.walls[at(i)].previous);
    return;
  }
  for (const int first : loops) {
    // The walls of a loop, one after the other.
    const int base = static_cast<int>(data.size());
    int count = 0;
    for (int i = first; count == 0 || i != first; i = table_.walls[at(i)].next) ++count;
    int k = 0;
    for (int i = first; k < count; i = table_.walls[at(i)].next, ++k)
      add(i, base + (k + 1) % count, base + (k + count - 1) % count);
  }
}

/// The loops of walls that, made_.displaced by a lattice vector, may made_.reach into the cell, by
/// that vector. A loop too many costs time, one too few would lose walls: so boxes are compared,
/// and circles by their distance from the edges, with the rounding of this comparison on the safe
/// side.
auto PieceTable::Preparation::loops_that_reach() const -> std::vector<Images> {
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
  /// Largest signed distance of a box, made_.displaced, from an edge's line, inside positive.
  const auto reach_of = [](const Box& box, Vector t, const Edge& e) {
    double farthest = -HUGE_VAL;
    for (const Vector& corner :
         {box.low, box.high, Vector{box.low.x, box.high.y}, Vector{box.high.x, box.low.y}})
      farthest = std::max(farthest, geometry::cross(e.direction, corner + t - e.from) / e.length);
    return farthest;
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
  for (const PreparedCurve& c : curves) wall_size = std::max(wall_size, 2.0 * c.extent);
  const Box whole = hull_of(boxes);
  const Box cell = hull_of(lattice.edges, [](const CellEdge& e) {
    return Box{e.segment.from, e.segment.from};
  });
  constexpr std::size_t most = 65536;
  const auto copies = cells_that_reach(lattice, whole, cell, most);
  if (!copies)
    throw InputError(
        "copies of the walls and supports from more than " + std::to_string(most) +
        " cells of the lattice made_.reach into one: the table is too wide for its lattice");
  const std::vector<std::vector<int>> loops = table::wall_loops(table_);
  for (const Cell& cell_of_copy : *copies) {
    if (cell_of_copy == Cell{}) continue;
    const Vector t = displacement(lattice, cell_of_copy);
    if (outside(whole, 0.5 * wall_size, t)) continue;
    Images copies_there{cell_of_copy, {}};
    const auto reaches = [&](int wall) {
      const PreparedCurve& c = curves[at(wall)];
      return c.kind == CurveKind::circle ? !circle_outside(c, t)
                                         : !outside(boxes[at(wall)], c.extent, t);
    };
    for (const std::vector<int>& loop : loops)
      if (std::any_of(loop.begin(), loop.end(), reaches))
        copies_there.loops.push_back(loop.front());
    if (!copies_there.loops.empty()) found.push_back(std::move(copies_there));
  }
  return found;
}

/// Which walls are certain to lie inside of the cell: no flight from one of them begins elsewhere.
void PieceTable::Preparation::find_within() {
  for (std::size_t i = 0; i < table_.walls.size(); ++i) {
    const PreparedCurve& w = curves[i];
    const Box box = bounding_box(table_.walls[i].curve);
    const bool disc = w.closed && w.kind == CurveKind::circle;
    data[i].within = true;
    for (std::size_t k = at(made_.first_edge); k < data.size(); ++k) {
      const PreparedCurve& e = *data[k].shape;
      const auto inside = [&](Vector x) { return geometry::cross(e.tangent, x - e.from); };
      const double least =
          disc ? inside(w.centre) - std::sqrt(w.r2)
               : std::min({inside(box.low), inside(box.high), inside({box.low.x, box.high.y}),
                           inside({box.high.x, box.low.y})});
      // The rounding of this comparison is on the safe side, as for the images of walls.
      data[i].within &= least > 32.0 * unit_roundoff * (2.0 * w.extent + 2.0 * norm_1(e.from));
    }
  }
}

/// A table is enclosed if one loop of convex pieces_, in their order, holds everything else, which
/// is discs.
void PieceTable::Preparation::find_enclosure(bool complement) {
  if (complement || offsets.size() > 1) return;  // a made_.displaced wall reaches into the cell
  if (table_.crossing) return;                   // then a disc may made_.reach beyond the loop
  if (made_.thin) return;                        // the exact stage gives the number
  std::vector<int> loop, others;
  for (int i = 0; i < static_cast<int>(data.size()); ++i) {
    const PreparedCurve& w = curves[at(data[at(i)].curve)];
    if (w.kind == CurveKind::bezier) return;
    const bool inside = w.kind == CurveKind::segment || w.orientation > 0;
    if (inside)
      loop.push_back(i);
    else if (w.closed && w.kind == CurveKind::circle)
      others.push_back(i);
    else
      return;
  }
  if (loop.empty()) return;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const PieceData& p = data[at(loop[k])];
    if (loop[k] != loop[0] + static_cast<int>(k)) return;
    if (p.closed && loop.size() == 1) break;
    if (p.closed || p.next != loop[(k + 1) % loop.size()] ||
        exact->corner(loop[k], p.next).turn < 0)
      return;
  }
  if (loop.size() > Enclosure::most) return;
  made_.enclosure_first = loop.front();
  for (const int i : loop) {
    const PreparedCurve& w = *data[at(i)].shape;
    const bool bent = w.kind != CurveKind::segment;
    made_.enclosure.add(w.from, bent ? Vector{} : w.tangent, w.length, bent);
  }
  discs = std::move(others);
  made_.convex = discs.empty() && !made_.cells;
  made_.discs_within = made_.cells;
  for (const int disc : discs) made_.discs_within &= data[at(disc)].within;
  if (!made_.convex) return;
  Box box = bounding_box(table_.walls.front().curve);
  double start_error = 0.0;
  made_.without_ellipses = true;
  for (const int i : loop) {
    made_.without_ellipses &= data[at(i)].kind != CurveKind::ellipse;
    box = hull(box, bounding_box(table_.walls[at(i)].curve));
    start_error = std::max(start_error, data[at(i)].shape->point_error);
  }
  made_.enclosure.set_diameter(1.01 * norm_1(box.high - box.low));
  made_.enclosure_rounding = 4.1 * unit_roundoff * made_.enclosure.diameter();
  // In l1 norms no chord is longer than the diameter d, no way from a joint to a point longer than
  // 2 d. Each of their coordinates errs by enclosure_rounding and its own last digit; products and
  // difference by 2u.
  const double d = made_.enclosure.diameter();
  made_.inside_bound = made_.options.filter_inflation *
                       (3.0 * d * made_.enclosure_rounding + 4.1 * unit_roundoff * d * 2.0 * d);
  // Half the error of side_of_flight, for the farthest joint.
  made_.side_bound =
      made_.options.filter_inflation * 1.005 * (start_error + made_.enclosure_rounding);
}

/// Lines that have the same joints on their right can be moved into each other without passing one,
/// and what they cross on the way changes only where they touch an arc: never from inside, which is
/// where the domain is. So from one wall they leave by the same wall; also within the cap between
/// an arc and its chord if no joint is there (docs/developer/lanes.md has the proof).
void PieceTable::Preparation::find_signs(bool complement) {
  constexpr std::size_t most = 10;
  if (complement || made_.cells || made_.convex || made_.thin || table_.crossing ||
      data.size() > most)
    return;
  // A joint beyond a chord by no more than this counts as on it. The computed distance errs by
  // 8u reach (products of differences, 4u of them), so it is beyond by less than 20u reach: then no
  // line has it on one side and both ends of the chord on the other, each at least 12u reach away.
  // That is certain where a computed side exceeds four times its bound, half of side_error.
  const double margin = 8.0 * unit_roundoff * made_.reach;  // as `reach` bounds l1 norms
  for (const PieceData& p : data) {
    const PreparedCurve& w = *p.shape;
    if (p.closed || w.orientation < 0.0 || p.kind > CurveKind::circle) return;
    if (p.kind == CurveKind::segment) continue;
    const Vector chord = w.to - w.from;
    // Some thousand times what the distances below can err by: a joint as near to the circle is
    // taken to be within, so that the table goes without this.
    const double radius = std::sqrt(w.r2) + 0x1p-40 * (std::sqrt(w.r2) + made_.reach + w.extent);
    for (const PieceData& other : data) {
      const Vector joint = other.shape->from, e = joint - w.centre;
      if (&other == &p || &other == &data[at(p.next)]) continue;
      if (geometry::cross(chord, joint - w.from) < -margin * std::sqrt(dot(chord, chord)) &&
          std::sqrt(dot(e, e)) < radius)
        return;
    }
  }
  for (const PieceData& p : data) made_.signs.add(p.shape->from, Vector{}, 0.0, false);
}

/// Pieces of a loop follow each other, and are neighbours: a tree of them pays if loops are long.
bool PieceTable::Preparation::has_long_loops() const {
  constexpr std::size_t long_loop = 8;  // pieces, on average
  std::size_t loops = 0;
  for (std::size_t i = 0; i < table_.walls.size(); ++i)
    if (table_.walls[i].next <= static_cast<int>(i)) ++loops;
  return loops * long_loop <= table_.walls.size();
}

/// With edges nothing matters outside the lattice's cell; else a flight may start anywhere, but
/// what does not made_.reach a wall ends nowhere.
void PieceTable::Preparation::make_grid(bool edges) {
  if (pieces_.empty()) return;
  std::vector<Box> boxes;
  const Vector none{0.0, 0.0};
  const Vector first = made_.cells ? table_.lattice->first : none,
               second = made_.cells ? table_.lattice->second : none;
  if (made_.cells && edges) {
    for (const CellEdge& e : table_.lattice->edges) boxes.push_back(bounding_box(e.segment));
  } else {
    for (const Piece& p : pieces_) {
      Box box = bounding_box(p.curve);
      if (!(p.offset == Cell{})) {
        // Displaced, with the rounding on the safe side.
        const Vector t = table_.lattice->translation(p.offset);
        const double m = std::fabs(static_cast<double>(p.offset.first)),
                     n = std::fabs(static_cast<double>(p.offset.second));
        const double size = std::max({std::fabs(box.low.x), std::fabs(box.low.y),
                                      std::fabs(box.high.x), std::fabs(box.high.y)});
        const double margin = 8.0 * unit_roundoff * (m * norm_1(first) + n * norm_1(second) + size);
        box = {{box.low.x + t.x - margin, box.low.y + t.y - margin},
               {box.high.x + t.x + margin, box.high.y + t.y + margin}};
      }
      boxes.push_back(box);
    }
  }
  grid = std::make_unique<const WallGrid>(pieces_, first, second, geometry::hull_of(boxes));
  list_near(first, second);
}

/// The disc of an obstacle that is one; about others a disc whose centre is a double. Each is then
/// displaced.
void PieceTable::Preparation::list_near(Vector first, Vector second) {
  struct Disc {
    Vector centre;
    double r2 = 0.0;
  };
  std::vector<Disc> discs_about;
  discs_about.reserve(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) {
    const PieceData& p = data[i];
    const PreparedCurve& w = *p.shape;
    Disc disc{w.centre, -w.orientation * w.r2};
    double error = w.centre_error;
    if (!(p.closed && p.kind == CurveKind::circle)) {
      const Box box = bounding_box(pieces_[i].curve);
      disc.centre = 0.5 * (box.low + box.high);
      disc.r2 = 0.0;
      error = 0.0;
      const auto reach_to = [&](Vector x) {
        disc.r2 = std::min(disc.r2, -1.0001 * dot(x - disc.centre, x - disc.centre));
      };
      if (p.kind == CurveKind::bezier) {
        const BezierForm& curve = *w.parametrisation.bezier;
        for (std::size_t k = 0; k <= curve.degree; ++k) reach_to(curve.control[k]);
      } else {
        for (const double x : {box.low.x, box.high.x})
          for (const double y : {box.low.y, box.high.y}) reach_to({x, y});
      }
    }
    const Cell c = offsets[at(p.offset)];
    if (!(c == Cell{})) {
      // As in WallGrid: two products and a sum, and the displaced coordinate.
      disc.centre = disc.centre + table_.lattice->translation(c);
      const double m = std::fabs(static_cast<double>(c.first)),
                   n = std::fabs(static_cast<double>(c.second));
      error += 4.0 * unit_roundoff * (m * norm_1(first) + n * norm_1(second) + norm_1(disc.centre));
    }
    made_.near_reach = std::max(made_.near_reach, 1.01 * norm_1(disc.centre));
    made_.near_error = std::max(made_.near_error, error);
    discs_about.push_back(disc);
  }
  const std::vector<int>& entries = grid->entries();
  near.resize(entries.size() / 2);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Near& two = near[i / 2];
    const Disc& disc = discs_about[at(entries[i])];
    two.x[i % 2] = disc.centre.x;
    two.y[i % 2] = disc.centre.y;
    two.r2[i % 2] = disc.r2;
    two.piece[i % 2] = entries[i];
    two.offset[i % 2] = data[at(entries[i])].offset;
  }
}

}  // namespace carom::events
