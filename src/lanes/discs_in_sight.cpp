#include "lanes/discs_in_sight.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "carom/geometry/vector.hpp"

namespace carom::lanes {

using geometry::Vector;

namespace {

// What rounding moves a flight by among the entries, in entries: its direction by less than 2^-42, its offset
// by 2^-40 S/r.
constexpr double slack = 0x1p-20;
constexpr double largest_sizes_of_radius = 0x1p10;
// Discs farther away in one of the lattice's directions are not looked for.
constexpr int farthest = 16;
constexpr long most_open = LaneTable::entries / 32;  // of a half
// Who still goes from cell to cell goes far.
constexpr int steps_of_walkers = 12;

struct Range {
  double low, high;
  friend Range operator+(const Range& a, const Range& b) { return {a.low + b.low, a.high + b.high}; }
};

/// A copy of the disc, seen from the one where flights begin.
struct Disc {
  int first, second;
  Vector place;
  double distance;
};

/// The discs that some flights see: they meet the first one, or pass it and meet the other.
struct Seen {
  const Disc* first;
  const Disc* then;
};

/// Flights of unit speed that begin on a disc: directions from `from` to `to`, v x (centre - start) between
/// two offsets.
struct Flights {
  Vector from, to;
  double angle;  ///< between them, or more
  Range offsets;
};

/// The values of a function of the direction that is a sine of this amplitude: off the straight line between
/// its ends by an eighth of its second derivative.
Range of_sine(double a, double b, double amplitude, double angle) {
  const double off = 0.125 * amplitude * angle * angle;
  return {std::min(a, b) - off, std::max(a, b) + off};
}

class Sights {
 public:
  explicit Sights(LaneTable& t) : table_(t), entries_(LaneTable::entries, LaneTable::open_sight) {
    // A disc is cut, or passed, beyond the margin in which its discriminant would not be certain after the
    // longest flight. Here twice as far: what is entered need not be asked.
    constexpr double cells = 2.0 * farthest;
    const double margin = (1.0 + 0.125 * cells * cells) * 0x1p-36 * t.size * t.sizes_of_radius;
    margin_ = 2.0 * margin;
    t.directions_per_unit = (LaneTable::sight_directions / 2 - 0.6) / std::sqrt(0.5);
    t.offsets_per_length = (LaneTable::sight_offsets / 2 - 0.6) / t.radius[0];
    t.sight_near = (t.radius[0] - margin) * t.offsets_per_length;
    t.sight_far = (t.radius[0] + margin) * t.offsets_per_length;
    find_discs();
  }

  /// Opposite quadrants see opposite discs.
  std::vector<std::uint32_t> make() {
    for (int quadrant : {0, 2}) fill(quadrant, 0, LaneTable::sight_directions, 0, LaneTable::sight_offsets);
    if (open_ > most_open) entries_.clear();
    return std::move(entries_);
  }

 private:
  /// All of them up to a distance, nearest first.
  void find_discs() {
    const Vector a{table_.lattice_x[0], table_.lattice_y[0]}, b{table_.lattice_x[1], table_.lattice_y[1]};
    const double area = std::fabs(cross(a, b));
    // L = n a + m b has |n| = |L x b| / |a x b|.
    complete_to_ = farthest * area / std::sqrt(std::max(dot(a, a), dot(b, b)));
    for (int n = -farthest; n <= farthest; ++n)
      for (int m = -farthest; m <= farthest; ++m) {
        const Vector place = static_cast<double>(n) * a + static_cast<double>(m) * b;
        const double distance = std::sqrt(dot(place, place));
        if ((n != 0 || m != 0) && distance < complete_to_) discs_.push_back({n, m, place, distance});
      }
    std::sort(discs_.begin(), discs_.end(),
              [](const Disc& p, const Disc& q) { return p.distance < q.distance; });
  }

  /// Those of the entries from one direction and offset up to, but without, another.
  Flights flights(int quadrant, int direction, int end_direction, int offset, int end_offset) const {
    const double half = 0.5 * LaneTable::sight_directions, middle = 0.5 * LaneTable::sight_offsets;
    const double largest = std::sqrt(0.5) * (1.0 + slack), r = table_.radius[0];
    const auto small = [&](double at) {
      return std::clamp((at - 0.5 - half) / table_.directions_per_unit, -largest, largest);
    };
    const auto aside = [&](double at) {
      return std::clamp((at - 0.5 - middle) / table_.offsets_per_length, -r - margin_, r + margin_);
    };
    const auto unit = [&](double x) {
      const double big = std::sqrt(1.0 - x * x);
      return quadrant == 0 ? Vector{big, x} : Vector{x, big};
    };
    const double from = small(direction - slack), to = small(end_direction + slack);
    return {unit(from), unit(to), 1.5 * (to - from), {aside(offset - slack), aside(end_offset + slack)}};
  }

  /// What all of these flights see: a disc, or a disc and the one behind it.
  std::optional<Seen> seen_by(const Flights& f) const {
    struct Met {
      const Disc* disc;
      Range ahead;
    };
    Met maybe{}, first{};
    const double r = table_.radius[0], both = 4.0 * r * r;
    for (const Disc& disc : discs_) {
      // A line that cuts both discs goes on by at least this from the one centre to the other.
      if (first.disc &&
          std::sqrt(std::max(disc.distance * disc.distance - both, 0.0)) > first.ahead.high + margin_)
        break;
      if (&disc == &discs_.back()) return {};
      const Range side =
          f.offsets + of_sine(cross(f.from, disc.place), cross(f.to, disc.place), disc.distance, f.angle);
      if (side.low > r + margin_ || side.high < -r - margin_) continue;
      const Range ahead = of_sine(dot(f.from, disc.place), dot(f.to, disc.place), disc.distance, f.angle);
      if (ahead.high < -margin_) continue;
      if (ahead.low < margin_) return {};
      const bool is_cut = side.low > -r + margin_ && side.high < r - margin_;
      // Those that are cut are in the order of their centres. All maybes are kept until one is known to lie
      // behind.
      const auto before = [&](const Met& m) { return m.disc && m.ahead.high + margin_ < ahead.low; };
      const auto behind = [&](const Met& m) { return m.disc && m.ahead.low > ahead.high + margin_; };
      if (before(first)) continue;
      if (is_cut) {
        if (first.disc && !behind(first)) return {};
        first = {&disc, ahead};
        if (maybe.disc && behind(maybe)) maybe = {};
        if (maybe.disc && !before(maybe)) return {};
      } else {
        if (first.disc && !behind(first)) return {};
        if (maybe.disc) return {};
        maybe = {&disc, ahead};
      }
    }
    if (!first.disc) return {};
    return Seen{maybe.disc ? maybe.disc : first.disc, first.disc};
  }

  /// All entries of these directions and offsets: together if they have one answer, else by quarters.
  void fill(int quadrant, int direction, int end_direction, int offset, int end_offset) {
    if (open_ > most_open) return;
    if (const auto seen = seen_by(flights(quadrant, direction, end_direction, offset, end_offset))) {
      return enter(quadrant, direction, end_direction, offset, end_offset, *seen);
    }
    if (end_direction - direction == 1 && end_offset - offset == 1) {
      ++open_;
      return;
    }
    const auto halves = [](int from, int to, const auto& each) {
      const int middle = to - from == 1 ? to : (from + to) / 2;
      each(from, middle);
      if (middle < to) each(middle, to);
    };
    halves(direction, end_direction, [&](int d, int end_d) {
      halves(offset, end_offset, [&](int o, int end_o) { fill(quadrant, d, end_d, o, end_o); });
    });
  }

  void enter(int quadrant, int direction, int end_direction, int offset, int end_offset, const Seen& seen) {
    const auto entry = [&](int q, int d, int o) -> std::uint32_t& {
      return entries_[static_cast<std::size_t>(
          (q * LaneTable::sight_directions + d) * LaneTable::sight_offsets + o)];
    };
    const auto sight = [&](int sign) {
      return LaneTable::sight_of(sign * seen.first->first, sign * seen.first->second, sign * seen.then->first,
                                 sign * seen.then->second);
    };
    const std::uint32_t number = sight(1), opposite = sight(-1);
    for (int d = direction; d < end_direction; ++d)
      for (int o = offset; o < end_offset; ++o) {
        entry(quadrant, d, o) = number;
        if (d > 0)
          entry(quadrant + 1, LaneTable::sight_directions - d, o) = opposite;  // no flight has direction 0
      }
  }

  LaneTable& table_;
  std::vector<std::uint32_t> entries_;
  std::vector<Disc> discs_;
  double complete_to_ = 0.0, margin_ = 0.0;
  long open_ = 0;
};

}  // namespace

std::vector<std::uint32_t> discs_in_sight(LaneTable& t) {
  if (t.edges == 0 || t.pieces != 1 || t.divided || !(t.sizes_of_radius < largest_sizes_of_radius)) return {};
  std::vector<std::uint32_t> entries = Sights(t).make();
  if (entries.empty()) return {};
  t.sights = entries.data();
  t.steps = steps_of_walkers;
  return entries;
}

}  // namespace carom::lanes
