#include "lanes/free/make_lane_table.hpp"

#include "base/index.hpp"
#include "lanes/free/exit_by_signs.hpp"
#include "table/bezier_wall.hpp"
#include "table/thin_walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace carom::lanes {

using geometry::CurveKind;
using geometry::PreparedCurve;
using geometry::Vector;

namespace {

using base::at;

/// The parts of a wall between the ends of its holes.
struct Part {
  double from;
  int hole;
};
std::vector<Part> parts_of(const Table& table, int wall) {
  const Wall& w = table.walls[at(wall)];
  std::vector<Part> parts;
  double from = 0.0;
  for (const int h : w.holes) {
    const Hole& hole = table.holes[at(h)];
    if (hole.from > from) parts.push_back({from, -1});
    parts.push_back({hole.from, h});
    from = hole.to;
  }
  if (from < geometry::end_parameter(w.curve)) parts.push_back({from, -1});
  return parts;
}

/// Beside what it has in common with circles.
void add_ellipse(LaneTable& t, const PreparedCurve& w, int i) {
  auto& all = t.ellipses;
  all.any = all.of[i] = true;
  const auto size = [](Vector v) { return std::fabs(v.x) + std::fabs(v.y); };
  const double row = std::max(size(w.first_axis), size(w.second_axis));
  const double largest = 1.0 / std::sqrt(std::min(w.first_weight, w.second_weight));
  all.axis_x[i] = w.first_direction.x;
  all.axis_y[i] = w.first_direction.y;
  all.along[i] = w.first_weight;
  all.across[i] = w.second_weight;
  all.first_x[i] = w.first_axis.x;
  all.first_y[i] = w.first_axis.y;
  all.second_x[i] = w.second_axis.x;
  all.second_y[i] = w.second_axis.y;
  all.stretch[i] = row * row;
  all.shrink[i] = 1.0 / (row * row);
  // The form of the velocity, by which a time is divided, may be less than a circle's by the square
  // of the axes' ratio.
  t.order_margin = std::max(t.order_margin, 0x1p-21 * (row * largest) * (row * largest));
  // In units of the table's size, which is not complete yet.
  all.off[i] = 0x1p-39 / largest;
  all.at_start[i] = t.closed[i] ? 0x1p-36 * row : 0.0;
  all.inward[i] = 0x1p-36 * row * row;
  t.size =
      std::max({t.size, 4.0 * (largest + size(w.centre)), 0x1p40 * w.normal_bound / (row * row)});
}

void add_piece(LaneTable& t, const PreparedCurve& w, int wall, const Part& part, bool whole) {
  const int i = t.pieces++;
  const Vector joint = part.from == 0.0 ? w.from : w.point(part.from);
  t.joint_x[i] = joint.x;
  t.joint_y[i] = joint.y;
  t.wall[i] = wall;
  t.from[i] = part.from;
  t.hole[i] = part.hole;
  t.bent[i] = w.kind != CurveKind::segment;
  t.closed[i] = w.closed && whole;
  const Vector point = t.bent[i] ? w.centre : w.from;
  t.point_x[i] = point.x;
  t.point_y[i] = point.y;
  t.first_number[i] = t.bent[i] ? w.weight : w.tangent.y;
  t.second_number[i] = t.bent[i] ? w.r2 : -w.tangent.x;
  t.orientation[i] = t.bent[i] ? w.orientation : 0.0;
  t.strength[i] = t.bent[i] ? w.strength : 2.0;
  if (w.kind != CurveKind::ellipse) (t.bent[i] ? t.circles : t.segments) = true;
  t.closed_circles |= w.closed && w.kind == CurveKind::circle;
  // Beyond every length that occurs, and 2^48 times every error of a point.
  t.size = std::max({t.size, 4.0 * w.extent, 0x1p48 * w.point_error, 0x1p48 * w.centre_error});
  if (w.kind == CurveKind::ellipse) add_ellipse(t, w, i);
  if (w.kind != CurveKind::circle) return;
  t.radius[i] = std::sqrt(w.r2);
  t.size = std::max(t.size, 4.0 * (t.radius[i] + std::fabs(w.centre.x) + std::fabs(w.centre.y)));
}

/// From the joint where a piece begins to the one where it ends.
void add_chord(LaneTable& t, int i, int next) {
  const Vector joint{t.joint_x[i], t.joint_y[i]};
  const Vector d = Vector{t.joint_x[next], t.joint_y[next]} - joint;
  t.length[i] = std::sqrt(dot(d, d));
  const Vector chord{d.x / t.length[i], d.y / t.length[i]};
  t.along_x[i] = d.x;
  t.back_y[i] = -d.y;
  t.turn[i] = geometry::cross(joint, joint + d);
  t.chord_x[i] = chord.x;
  t.chord_y[i] = chord.y;
  if (t.radius[i] > 0.0)
    t.chord_offset[i] =
        geometry::cross(chord, Vector{t.point_x[i], t.point_y[i]} - joint) / t.radius[i];
}

double part(std::int64_t n, Vector v) {
  return std::fabs(static_cast<double>(n)) * (std::fabs(v.x) + std::fabs(v.y));
}

/// Are all walls discs that do not reach an edge of the cell? As PieceTable::find_enclosure.
bool discs_within_cell(const Table& table) {
  if (table.lattice->edges.size() != 4 && table.lattice->edges.size() != 6) return false;
  double size = 0.0;
  for (const geometry::CellEdge& edge : table.lattice->edges)
    size = std::max(size, std::fabs(edge.segment.from.x) + std::fabs(edge.segment.from.y) +
                              part(edge.beyond.first, table.lattice->first) +
                              part(edge.beyond.second, table.lattice->second));
  for (const Wall& wall : table.walls) {
    const PreparedCurve w(wall.curve);
    if (!w.closed || w.kind != CurveKind::circle || w.orientation > 0) return false;
    for (const geometry::CellEdge& edge : table.lattice->edges) {
      const PreparedCurve e(edge.segment);
      const double gap = geometry::cross(e.tangent, w.centre - e.from) - std::sqrt(w.r2);
      if (!(gap > 0x1p-36 * (w.extent + size)))
        return false;  // beyond 2^-40 S: no line along an edge cuts it (docs/developer/lanes.md)
    }
  }
  return true;
}

/// Is an edge as short as errors are? So are two of a hexagon that is a rectangle except for
/// rounding.
bool is_short(const geometry::Segment& edge) {
  const Vector along = edge.to - edge.from;
  return std::fabs(along.x) + std::fabs(along.y) <
         0x1p-42 * (std::fabs(edge.from.x) + std::fabs(edge.from.y));
}

/// The cell of a lattice. Without its short edges it is another one by less than any disc keeps
/// from them.
void add_cell(LaneTable& t, const geometry::Lattice& lattice, double mean_flight) {
  const std::size_t edges = lattice.edges.size(), half = edges / 2;
  for (std::size_t i = 0; i < edges; ++i) {
    const geometry::CellEdge& edge = lattice.edges[i];
    if (is_short(edge.segment) || is_short(lattice.edges[(i + half) % edges].segment)) continue;
    const Vector corner = edge.segment.from;
    const Vector along = edge.segment.to - corner, beyond = lattice.translation(edge.beyond);
    t.edge_x[t.edges] = corner.x;
    t.edge_y[t.edges] = corner.y;
    t.edge_along_x[t.edges] = along.x;
    t.edge_along_y[t.edges] = along.y;
    t.beyond_x[t.edges] = beyond.x;
    t.beyond_y[t.edges] = beyond.y;
    t.beyond_first[t.edges] = static_cast<double>(edge.beyond.first);
    t.beyond_second[t.edges++] = static_cast<double>(edge.beyond.second);
    // Lattice vectors that are long for their cell are many to the next one: what cells sum up has
    // their size.
    t.size = std::max({t.size, 4.0 * (std::fabs(corner.x) + std::fabs(corner.y)),
                       2.0 * (part(edge.beyond.first, lattice.first) +
                              part(edge.beyond.second, lattice.second))});
  }
  for (const Vector& v : {lattice.first, lattice.second})
    t.size = std::max(t.size, 4.0 * (std::fabs(v.x) + std::fabs(v.y)));
  // By how many edges the mean flight passes: isotropic lines cross the boundary of a cell
  // perimeter/(pi area) times a length.
  double perimeter = 0.0;
  for (const geometry::CellEdge& edge : lattice.edges) {
    const Vector along = edge.segment.to - edge.segment.from;
    perimeter += std::sqrt(dot(along, along));
  }
  const double passed =
      mean_flight * perimeter / (std::numbers::pi * geometry::cross(lattice.first, lattice.second));
  // Some more, and still more where an edge costs little (parallelograms.hpp).
  t.steps = (t.edges == 4 ? 4 : 2) + static_cast<int>(std::lround(std::clamp(passed, 0.0, 5.0)));
  // Opposite corners of a parallelogram; a hexagon does not ask.
  t.off_centre_x = 0.5 * (t.edge_x[0] + t.edge_x[2]) - t.point_x[0];
  t.off_centre_y = 0.5 * (t.edge_y[0] + t.edge_y[2]) - t.point_y[0];
  t.lattice_x[0] = lattice.first.x;
  t.lattice_y[0] = lattice.first.y;
  t.lattice_x[1] = lattice.second.x;
  t.lattice_y[1] = lattice.second.y;
}

/// Of the lattice's cell: its middle, and the distance of its farthest corner.
std::pair<Vector, double> middle_of_cell(const geometry::Lattice& lattice) {
  Vector middle{};
  for (const geometry::CellEdge& edge : lattice.edges)
    middle = middle + (1.0 / static_cast<double>(lattice.edges.size())) * edge.segment.from;
  double farthest = 0.0;
  for (const geometry::CellEdge& edge : lattice.edges)
    farthest = std::max(farthest, dot(edge.segment.from - middle, edge.segment.from - middle));
  return {middle, std::sqrt(farthest)};
}

/// The cells whose discs flights from the home cell may meet that get no farther than `reach` from
/// where they began, the home cell first; none where these are too many. One cell more does no
/// harm, so lengths are taken with some room.
std::vector<geometry::Cell> cells_within(const Table& table, double reach) {
  const geometry::Lattice& lattice = *table.lattice;
  const std::pair<Vector, double> around = middle_of_cell(lattice);
  const Vector middle = around.first;
  const double corner = around.second;
  double most = 0.0;
  for (const Wall& wall : table.walls) {
    const PreparedCurve w(wall.curve);
    most = std::max(most, 2.0 * corner + reach + std::sqrt(w.r2));
  }
  most *= 1.0 + 0x1p-20;
  // A cell k vectors away lies k times the height of the cell on their side away at least.
  const double area = lattice.cell_area();
  const auto farthest = [&](Vector other) {
    return std::floor(most * std::sqrt(dot(other, other)) * (1.0 + 0x1p-20) / area);
  };
  const double first = farthest(lattice.second), second = farthest(lattice.first);
  if (!((2.0 * first + 1.0) * (2.0 * second + 1.0) < 1e5)) return {};
  std::vector<geometry::Cell> cells{{}};
  for (auto i = -static_cast<std::int64_t>(first); i <= static_cast<std::int64_t>(first); ++i)
    for (auto j = -static_cast<std::int64_t>(second); j <= static_cast<std::int64_t>(second); ++j) {
      const geometry::Cell cell{i, j};
      const Vector way = lattice.translation(cell);
      const bool near = std::any_of(table.walls.begin(), table.walls.end(), [&](const Wall& wall) {
        const PreparedCurve w(wall.curve);
        const Vector d = w.centre + way - middle;
        return std::sqrt(dot(d, d)) < (reach + std::sqrt(w.r2) + corner) * (1.0 + 0x1p-20);
      });
      if (near && (i != 0 || j != 0)) cells.push_back(cell);
    }
  return cells;
}

/// The pieces of those cells. Their centres and joints are rounded by less than those of `size`
/// count with.
void add_copies(LaneTable& t, const geometry::Lattice& lattice,
                const std::vector<geometry::Cell>& cells) {
  const int loops = t.loops;
  for (int i = 0; i < t.own; ++i) t.copy_of[i] = i;
  for (const geometry::Cell& cell : cells) {
    if (cell == geometry::Cell{}) continue;
    const Vector way = lattice.translation(cell);
    for (int loop = 0; loop < loops; ++loop) {
      t.first[t.loops] = t.pieces;
      t.count[t.loops++] = t.count[loop];
      for (int from = t.first[loop]; from < t.first[loop] + t.count[loop]; ++from) {
        const int i = t.pieces++;
        for (double* const numbers :
             {t.first_number, t.second_number, t.orientation, t.strength, t.chord_x, t.chord_y,
              t.length, t.radius, t.chord_offset, t.along_x, t.back_y, t.hole, t.from})
          numbers[i] = numbers[from];
        t.bent[i] = t.bent[from];
        t.closed[i] = t.closed[from];
        t.joint_x[i] = t.joint_x[from] + way.x;
        t.joint_y[i] = t.joint_y[from] + way.y;
        t.point_x[i] = t.point_x[from] + way.x;
        t.point_y[i] = t.point_y[from] + way.y;
        t.wall[i] = -2.0;
        t.copy_of[i] = from;
        t.copy_first[i] = static_cast<double>(cell.first);
        t.copy_second[i] = static_cast<double>(cell.second);
        t.size = std::max(t.size,
                          4.0 * (t.radius[i] + std::fabs(t.point_x[i]) + std::fabs(t.point_y[i])));
      }
    }
  }
}

std::size_t pieces_of(const Table& table) {
  std::size_t pieces = 0;
  for (std::size_t i = 0; i < table.walls.size(); ++i)
    pieces += parts_of(table, static_cast<int>(i)).size();
  return pieces;
}

/// One loop of walls that turns to the left everywhere, and nothing in it: as
/// PieceTable::find_enclosure.
bool is_convex(const events::PieceTable& walls) {
  const Table& table = walls.table;
  const int n = static_cast<int>(table.walls.size());
  if (table.crossing || table.lattice) return false;
  for (int i = 0; i < n; ++i) {
    const PreparedCurve& w = walls.curve(i);
    if (w.kind != CurveKind::segment && !(w.orientation > 0)) return false;
    if (n == 1) return true;
    if (w.closed || table.walls[at(i)].next != (i + 1) % n) return false;
    if (walls.exact->corner(i, (i + 1) % n).turn < 0) return false;
  }
  return true;
}

}  // namespace

std::string misfit(const Table& table, double reach) {
  static_assert(LaneTable::most == 64);  // as the texts say
  const std::size_t pieces = pieces_of(table);
  if (pieces == 0) return "there are no walls";
  if (pieces > LaneTable::most) return "more than 64 walls, the parts between holes counted";
  if (table.crossing) return "walls cross";
  if (table::bezier_wall(table) != nullptr) return "Bézier curves among the walls";
  if (table::has_thin_walls(table)) return "walls so thin that hits on them are computed exactly";
  if (!table.lattice) return {};
  if (!discs_within_cell(table)) return "walls on a lattice that are no discs inside its cell";
  if (reach == HUGE_VAL) return {};
  const std::size_t cells = cells_within(table, reach).size();
  return cells > 0 && cells * pieces <= LaneTable::most
             ? ""
             : "Larmor circles that may come to more than 64 walls of the lattice";
}

LaneTable make_lane_table(const events::PieceTable& walls, double reach) {
  const Table& table = walls.table;
  LaneTable t;
  std::vector<bool> done(table.walls.size(), false);
  for (std::size_t start = 0; start < table.walls.size(); ++start) {
    if (done[start]) continue;
    const int loop = t.loops++;
    t.first[loop] = t.pieces;
    for (int wall = static_cast<int>(start); !done[at(wall)]; wall = table.walls[at(wall)].next) {
      done[at(wall)] = true;
      const std::vector<Part> parts = parts_of(table, wall);
      t.divided |= parts.size() > 1 || parts[0].hole >= 0;
      const int ellipse = walls.ellipse_of(wall), curve = ellipse < 0 ? wall : ellipse;
      t.divided |= curve != wall;
      for (const Part& part : parts) {
        t.ellipses.curve[t.pieces] = curve;
        add_piece(t, walls.curve(wall), wall, part, parts.size() == 1);
      }
    }
    t.count[loop] = t.pieces - t.first[loop];
    const int first = t.first[loop];
    for (int i = first; i < t.pieces && !t.closed[first]; ++i)
      add_chord(t, i, i + 1 < t.pieces ? i + 1 : first);
  }
  t.own = t.pieces;
  if (table.lattice) add_cell(t, *table.lattice, measure(table).mean_flight);
  if (table.lattice && reach < HUGE_VAL) add_copies(t, *table.lattice, cells_within(table, reach));
  // A power of two. Lanes decide nothing where products of sizes might leave the range of doubles.
  t.size = t.size > 1e-30 && t.size < 1e30 ? std::ldexp(1.0, std::ilogb(t.size) + 1) : HUGE_VAL;
  // A hit is off its circle by 2^-50 of the square of the flight, which is within S, over many
  // cells within 16 S. With r^2 above 2^-20 or 2^-12 S^2 no step of length is 2^-28, half of that
  // share.
  t.sizes_of_radius = t.size / t.radius[0];
  const double smallest = table.lattice ? 0x1p-6 : 0x1p-10;
  for (int i = 0; i < t.own; ++i) {
    auto& e = t.ellipses;
    e.off[i] = e.of[i] ? e.off[i] * t.size : HUGE_VAL;
    e.at_start[i] *= t.size;
    e.inward[i] = t.size * (e.of[i] ? e.inward[i] : 0x1p-36);
    t.divided |= t.wall[i] != i;
    t.small_circles |= t.radius[i] > 0.0 && t.radius[i] < smallest * t.size;
  }
  // A line between the joints of an arc, 2^-36 S from both, passes the circle's rim at that
  // distance at least: under the root is more than 2^-36 S r s^2, and what it errs, 2^-44 S^2 s^2,
  // moves a hit off the arc by 2^-45 S^2/r.
  bool wide_arcs = true;
  for (int i = 0; i < t.pieces; ++i)
    wide_arcs &= t.pieces == 1 || t.radius[i] == 0.0 || t.radius[i] > 0x1p-7 * t.size;
  t.start_margin = 0x1p-36 * t.size;
  t.open = table.extent == Extent::open_plane;
  t.convex = is_convex(walls);
  if (wide_arcs) prepare_exits(t);
  t.by_line = wide_arcs && (t.convex || t.by_signs);
  t.start_step = t.by_signs ? std::ldexp(1.0, t.pieces) : 1.0;
  t.from_start = t.by_signs ? 0.5 * (t.start_step - 1.0) : 0.5 * t.pieces;
  return t;
}

void leave_short_arcs(LaneTable& t) {
  // Joints err by 2^-52 S, the ends of holes among them, so such a chord's direction by 2^-23; the
  // middle of an arc may by 2^-22.
  for (int i = 0; i < t.pieces; ++i)
    if (t.bent[i] && t.length[i] > 0.0 && t.length[i] < 0x1p-28 * t.size) t.size = HUGE_VAL;
}

int piece_at(const LaneTable& t, int wall, double u) {
  int found = -1;
  for (int i = 0; i < t.pieces; ++i)
    if (static_cast<int>(t.wall[i]) == wall && t.from[i] <= u) found = i;
  return found;
}

}  // namespace carom::lanes
