// Which grid, how many near copies and what degree a table has; and its numbers.
#include <algorithm>
#include <cmath>
#include <limits>

#include "forces/lattice_bumps.hpp"

namespace carom::forces {

using geometry::Vector;

namespace {

constexpr std::size_t most_numbers = std::size_t{1}
                                     << 16;  // half a megabyte: what a core keeps near
/// At all nodes together, where a finer grid than the coarsest is tried: a second of preparation.
constexpr double most_copies_at_nodes = 2e6;
constexpr int most_near_beside_a_polynomial = 8;
constexpr std::size_t orders = LatticeSum::most_degree + 1;

struct Basis {
  Vector first, second;
};

/// The two shortest vectors that span the lattice: over edges of its cell.
Basis shortest(const geometry::Lattice& lattice) {
  std::vector<Vector> over;
  for (const geometry::CellEdge& e : lattice.edges) over.push_back(lattice.translation(e.beyond));
  std::stable_sort(over.begin(), over.end(),
                   [](Vector a, Vector b) { return dot(a, a) < dot(b, b); });
  const Vector first = over.front();
  const auto other = std::find_if(over.begin(), over.end(), [&](Vector v) {
    const double area = cross(first, v);
    return area * area > 0.25 * dot(first, first) * dot(v, v);
  });
  return {first, *other};
}

struct Copy {
  double square;
  Vector d;  ///< of a node from it
};

/// Calls visit(copy) for the copies about a point that are nearer than `reach`.
void for_copies_about(Vector node, const std::vector<Vector>& centers, const Basis& basis,
                      double reach, const auto& visit) {
  const double area = cross(basis.first, basis.second);
  // |m a + n b| >= |m| area/|b| and |n| area/|a|
  const double high_m = reach * std::sqrt(dot(basis.second, basis.second)) / std::fabs(area);
  const double high_n = reach * std::sqrt(dot(basis.first, basis.first)) / std::fabs(area);
  for (const Vector& center : centers) {
    const Vector d = node - center;
    const double m0 = cross(d, basis.second) / area, n0 = cross(basis.first, d) / area;
    for (double m = std::ceil(m0 - high_m - 1e-9); m <= m0 + high_m + 1e-9; m += 1.0)
      for (double n = std::ceil(n0 - high_n - 1e-9); n <= n0 + high_n + 1e-9; n += 1.0) {
        const Vector from{d.x - (m * basis.first.x + n * basis.second.x),
                          d.y - (m * basis.first.y + n * basis.second.y)};
        const double square = dot(from, from);
        if (square <= reach * reach) visit(Copy{square, from});
      }
  }
}

/// About how many they are, and not fewer unless the disc is smaller than a cell.
double copies_within(double reach, const std::vector<Vector>& centers,
                     const geometry::Lattice& lattice) {
  constexpr double square_about_disc = 4.0;
  return square_about_disc * reach * reach / lattice.cell_area() *
         static_cast<double>(centers.size());
}

/// All of them; the nearest `sorted` first.
std::vector<Copy> copies_about(Vector node, const std::vector<Vector>& centers, const Basis& basis,
                               double reach, std::size_t sorted) {
  std::vector<Copy> found;
  for_copies_about(node, centers, basis, reach, [&](const Copy& copy) { found.push_back(copy); });
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(std::min(sorted, found.size()));
  std::partial_sort(found.begin(), middle, found.end(), [](const Copy& a, const Copy& b) {
    if (a.square != b.square) return a.square < b.square;
    return a.d.x != b.d.x ? a.d.x < b.d.x : a.d.y < b.d.y;
  });
  return found;
}

Vector node_at(const Basis& basis, int grid, int i, int j) {
  // The upper half of the indices is below zero, as in two's complement.
  const double p = static_cast<double>(2 * i < grid ? i : i - grid) / grid;
  const double q = static_cast<double>(2 * j < grid ? j : j - grid) / grid;
  return {p * basis.first.x + q * basis.second.x, p * basis.first.y + q * basis.second.y};
}

/// Half the longer diagonal of a grid's mesh, a little enlarged for the rounding of X and Y.
double way_in_mesh(const Basis& basis, int grid) {
  const Vector sum = basis.first + basis.second, difference = basis.first - basis.second;
  return (0.5 + 0x1p-40) * std::sqrt(std::max(dot(sum, sum), dot(difference, difference))) / grid;
}

constexpr int padded(int near) { return (near + 7) / 8 * 8; }
constexpr int numbers_of_polynomial(int degree) {
  return degree < 0 ? 0 : 8 * (degree + 1) + (degree >= 8 ? 8 * (degree - 7) : 0);
}

constexpr int coarsest = 4;

struct Choice {
  int grid = 0, near = 0, degree = -1;
  double cost = std::numeric_limits<double>::infinity(), error = 0.0;
};

/// About what a point costs, in units of a near copy: measured for one point and for many.
double cost_of(int near, int degree) {
  return near + 2.5 * (padded(near) / 8) +
         (degree < 0 ? 0.0 : 1.5 + numbers_of_polynomial(degree) / 14.0);
}

/// Errors by distance: of the lower end of the bin that the distance is in.
class ErrorsByDistance {
 public:
  /// Errors fall with distance: wider bins, where there would be very many, only enlarge the bound.
  ErrorsByDistance(const BumpShape& shape, double way, double reach)
      : bin_(std::max(shape.length() / 8.0, (reach + way) / 65536.0)) {
    for (double r = 0.0; r <= reach + way; r += bin_)
      errors_.push_back(series_errors(shape, r, way));
  }
  std::size_t bin_of(double square) const {
    return std::min(static_cast<std::size_t>(std::sqrt(square) / bin_), errors_.size() - 1);
  }
  const SeriesErrors& at(std::size_t bin) const { return errors_[bin]; }
  std::size_t bins() const { return errors_.size(); }

 private:
  double bin_;
  std::vector<SeriesErrors> errors_;
};

/// The share of tail_share that is kept for copies whose series ends before the polynomial's
/// degree.
constexpr double early_share = 1.0 / 16.0;

/// What the series of the copies about a node leave out, except for the nearest 0, 1, ... of them.
class ErrorsAtNode {
 public:
  explicit ErrorsAtNode(const ErrorsByDistance& errors)
      : errors_(errors), counts_(errors.bins(), 0) {}

  /// A broad bump has many copies: they are counted by distance.
  void add(double square) {
    ++copies_;
    std::size_t at = near_;
    if (near_ < most_near)
      ++near_;
    else if (square < nearest_[most_near - 1])
      count(nearest_[at = most_near - 1]);
    else
      return count(square);
    for (; at > 0 && nearest_[at - 1] > square; --at) nearest_[at] = nearest_[at - 1];
    nearest_[at] = square;
  }
  std::size_t copies() const { return copies_; }
  /// Calls seen(k, errors) for all but the nearest k, k = most_near or all, ..., 0; then it is
  /// empty.
  void take(const auto& seen) {
    SeriesErrors sum{};
    const auto add_bin = [&](std::size_t bin, double times) {
      const SeriesErrors& error = errors_.at(bin);
      for (std::size_t n = 0; n < orders; ++n) sum[n] += times * error[n];
    };
    for (const std::size_t bin : filled_) {
      add_bin(bin, counts_[bin]);
      counts_[bin] = 0.0;
    }
    for (std::size_t k = near_;; --k) {
      seen(k, sum);
      if (k == 0) break;
      add_bin(errors_.bin_of(nearest_[k - 1]), 1.0);
    }
    filled_.clear();
    near_ = copies_ = 0;
  }

 private:
  static constexpr std::size_t most_near = most_near_beside_a_polynomial;
  void count(double square) {
    const std::size_t bin = errors_.bin_of(square);
    if (counts_[bin] == 0.0) filled_.push_back(bin);
    counts_[bin] += 1.0;
  }

  const ErrorsByDistance& errors_;
  std::vector<double> counts_;  ///< by bin, except for the nearest
  std::vector<std::size_t> filled_;
  std::array<double, most_near> nearest_{};  ///< squares of their distances, in order
  std::size_t near_ = 0, copies_ = 0;
};

/// The cheapest table on that grid whose error is below the bound.
Choice best_on(int grid, const BumpShape& shape, const std::vector<Vector>& centers,
               const Basis& basis, double reach) {
  const double way = way_in_mesh(basis, grid);
  const ErrorsByDistance errors(shape, way, reach);
  std::array<std::array<double, orders>, most_near_beside_a_polynomial + 1> largest{};
  std::size_t most_copies = 0;
  ErrorsAtNode at_node(errors);
  for (int i = 0; i < grid; ++i)
    for (int j = 0; j < grid; ++j) {
      for_copies_about(node_at(basis, grid, i, j), centers, basis, reach + way,
                       [&](const Copy& copy) { at_node.add(copy.square); });
      most_copies = std::max(most_copies, at_node.copies());
      at_node.take([&](std::size_t k, const SeriesErrors& sum) {
        for (std::size_t n = 0; n < orders; ++n) largest[k][n] = std::max(largest[k][n], sum[n]);
      });
    }
  Choice best{grid, static_cast<int>(most_copies), -1, cost_of(static_cast<int>(most_copies), -1),
              0.0};
  const auto nodes = static_cast<std::size_t>(grid) * static_cast<std::size_t>(grid);
  // A large table is slow, and a coarser one of many copies is not much larger than they are.
  if (nodes * 2 * static_cast<std::size_t>(padded(best.near)) > most_numbers)
    best.cost *= grid == coarsest ? 1.5 : std::numeric_limits<double>::infinity();
  for (int near = 0; near <= most_near_beside_a_polynomial && near < static_cast<int>(most_copies);
       ++near)
    for (int degree = 1; degree <= LatticeSum::most_degree; ++degree) {
      const double error =
          largest[static_cast<std::size_t>(near)][static_cast<std::size_t>(degree)];
      if (!(error <= (1.0 - early_share) * tail_share)) continue;
      const Choice choice{grid, near, degree, cost_of(near, degree), error};
      const auto each = static_cast<std::size_t>(2 * padded(near) + numbers_of_polynomial(degree));
      if (choice.cost < best.cost && nodes * each <= most_numbers) best = choice;
      break;
    }
  return best;
}

}  // namespace

std::optional<std::vector<Vector>> seen_from_copies(Vector point,
                                                    const std::vector<Vector>& centers,
                                                    const geometry::Lattice& lattice, double reach,
                                                    double most) {
  if (!(copies_within(reach, centers, lattice) <= most)) return {};
  std::vector<Vector> seen;
  for (const Copy& copy : copies_about(point, centers, shortest(lattice), reach, 0))
    seen.push_back(copy.d);
  return seen;
}

LatticeTable::LatticeTable(const BumpShape& shape, const std::vector<Vector>& centers,
                           const geometry::Lattice& lattice, double reach) {
  const Basis basis = shortest(lattice);
  Choice choice;
  const double in_reach = copies_within(reach, centers, lattice);
  for (const int grid : {coarsest, 8, 16, 32}) {
    if (grid > coarsest && grid * grid * in_reach > most_copies_at_nodes) break;
    const Choice c = best_on(grid, shape, centers, basis, reach);
    if (c.cost < choice.cost) choice = c;
    if (choice.degree < 0 && choice.near <= 4) break;  // finer ones gain nothing
  }
  error_ = choice.degree < 0 ? 0.0 : choice.error + early_share * tail_share;
  const double grid = choice.grid, area = cross(basis.first, basis.second);
  LatticeSum& t = sum_;
  t.to_first_x = grid * basis.second.y / area;
  t.to_first_y = -grid * basis.second.x / area;
  t.to_second_x = -grid * basis.first.y / area;
  t.to_second_y = grid * basis.first.x / area;
  t.first_x = basis.first.x / grid;
  t.first_y = basis.first.y / grid;
  t.second_x = basis.second.x / grid;
  t.second_y = basis.second.y / grid;
  t.mask = choice.grid - 1;
  while ((1 << t.shift) < choice.grid) ++t.shift;
  t.near = choice.near;
  t.padded_near = padded(choice.near);
  t.degree = choice.degree;
  t.stride = static_cast<std::size_t>(2 * t.padded_near + numbers_of_polynomial(t.degree));
  t.fermi = shape.kind == BumpShape::Kind::fermi;
  t.radius = shape.radius;
  t.inverse_softness = 1.0 / shape.softness;
  t.inverse_square_width = 1.0 / (shape.width * shape.width);

  const double way = way_in_mesh(basis, choice.grid), far = 2.0 * (reach + way);
  const auto near = static_cast<std::size_t>(t.near),
             columns = static_cast<std::size_t>(t.padded_near);
  const auto width = static_cast<std::size_t>(t.degree + 1);
  const auto count = static_cast<std::size_t>(choice.grid) * static_cast<std::size_t>(choice.grid);
  lines_.resize(count * t.stride / 8);
  t.nodes = lines_.empty() ? nullptr : lines_.front().numbers;
  const ErrorsByDistance errors(shape, way, t.degree < 0 ? 0.0 : reach);
  constexpr double negligible = early_share * tail_share;
  const Vector a{t.first_x, t.first_y}, b{t.second_x, t.second_y};
  std::size_t node = 0;
  for (int i = 0; i < choice.grid; ++i)
    for (int j = 0; j < choice.grid; ++j, ++node) {
      const auto copies =
          copies_about(node_at(basis, choice.grid, i, j), centers, basis, reach + way, near);
      copies_ = std::max(copies_, copies.size());
      const auto number = [&](std::size_t k) -> double& {
        const std::size_t all = node * t.stride + k;
        return lines_[all / 8].numbers[all % 8];
      };
      // Where a list is shorter it ends with copies that are out of reach of the whole mesh.
      for (std::size_t k = 0; k < near; ++k) {
        number(k) = k < copies.size() ? copies[k].d.x : far;
        number(columns + k) = k < copies.size() ? copies[k].d.y : far;
      }
      if (t.degree < 0) continue;
      std::vector<double> sum(width * width, 0.0);
      for (std::size_t k = near; k < copies.size(); ++k) {
        const SeriesErrors& left_out = errors.at(errors.bin_of(copies[k].square));
        int degree = 0;
        while (degree < t.degree && !(left_out[static_cast<std::size_t>(degree)] <=
                                      negligible / static_cast<double>(copies.size())))
          ++degree;
        add_series(shape, copies[k].d, a, b, degree, width, sum);
      }
      for (std::size_t row = 0; row < width; ++row)
        for (std::size_t power = 0; power + row < width; ++power) {
          const std::size_t at = power < 8 ? 8 * row + power : 8 * width + 8 * row + (power - 8);
          number(2 * columns + at) = sum[power + width * row];
        }
    }
}

}  // namespace carom::forces
