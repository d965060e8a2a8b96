#include "lanes/free/next_disc_table.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "carom/geometry/vector.hpp"
#include "lanes/free/lane_start.hpp"

namespace carom::lanes {

using geometry::Vector;

namespace {

// What rounding moves a flight by among the entries, in entries: its direction by less than 2^-42,
// its offset by 2^-39 S/r.
constexpr double slack = 0x1p-20;
constexpr double largest_sizes_of_radius = 0x1p10;
// Discs farther away in one of the lattice's directions are not looked for.
constexpr int farthest = 16;
constexpr long most_without =
    LaneTable::disc_directions * LaneTable::disc_offsets / 16;  // of a half
// Cells crossed per sweep by a lane that has not reached its first disc yet.
constexpr int steps_to_first_disc = 4;

struct Range {
  double low, high;
  friend Range operator+(const Range& a, const Range& b) {
    return {a.low + b.low, a.high + b.high};
  }
};

/// A copy of the disc, seen from the one where flights begin.
struct Disc {
  int first, second;
  Vector place;
  double distance;
};

/// The answer of the table for some flights: they meet the first disc if they cut it, or else the
/// other one if they cut that, or else pass both and go on from the second.
struct Seen {
  const Disc* first;
  const Disc* then;
};

/// Flights of unit speed that start on a disc, or pass it: directions from `from` to `to`, v x
/// (centre - start) between two offsets.
struct Flights {
  Vector from, to;
  double angle;  ///< between them, or more
  Range offsets;
};

/// The values of a function of the direction that is a sine of this amplitude: off the straight
/// line between its ends by an eighth of its second derivative.
Range of_sine(double a, double b, double amplitude, double angle) {
  const double off = 0.125 * amplitude * angle * angle;
  return {std::min(a, b) - off, std::max(a, b) + off};
}

/// A disc that they may meet, or may go on from.
struct Candidate {
  const Disc* disc;
  Range side, ahead;
};

class NextDiscTable {
 public:
  explicit NextDiscTable(LaneTable& t)
      : table_(t), radius_(t.radius[0]), entries_(LaneTable::entries, LaneTable::no_discs) {
    // A disc is cut beyond the margin in which its discriminant would not be certain after the
    // flight, of more cells the longer it is; and passed beyond that of a side. What is entered
    // lies twice as far from both, so it need not be asked.
    const auto margin = [&](double cells) {
      return (1.0 + 0.125 * cells * cells) * side_margin * t.size * t.sizes_of_radius;
    };
    margin_ = 2.0 * margin(LaneTable::farthest_cell);
    t.cut_within = radius_ - margin(LaneTable::near_cell);
    t.cut_within_far = radius_ - margin(LaneTable::farthest_cell);
    t.passed_beyond = radius_ + side_margin * t.size;
    find_discs();
    t.directions_per_unit = (LaneTable::disc_directions / 2 - 0.6) / std::sqrt(0.5);
    t.offsets_per_length = (LaneTable::disc_offsets / 2 - 0.6) / widest_;
  }

  /// Opposite quadrants have opposite discs.
  std::vector<std::uint32_t> make() {
    std::vector<const Disc*> all;
    for (const Disc& disc : discs_) all.push_back(&disc);
    for (int quadrant : {0, 2})
      fill(quadrant, 0, LaneTable::disc_directions, 0, LaneTable::disc_offsets, all);
    if (without_ > most_without) entries_.clear();
    return std::move(entries_);
  }

 private:
  /// All of them up to a distance, nearest first; and how far aside a disc may lie that a flight
  /// goes on from: between the rows that lie farthest apart one is never farther.
  void find_discs() {
    const Vector a{table_.lattice_x[0], table_.lattice_y[0]},
        b{table_.lattice_x[1], table_.lattice_y[1]};
    const double area = std::fabs(cross(a, b));
    // L = n a + m b has |n| = |L x b| / |a x b|.
    const double complete_to = farthest * area / std::sqrt(std::max(dot(a, a), dot(b, b)));
    for (int n = -farthest; n <= farthest; ++n)
      for (int m = -farthest; m <= farthest; ++m) {
        const Vector place = static_cast<double>(n) * a + static_cast<double>(m) * b;
        const double distance = std::sqrt(dot(place, place));
        if ((n != 0 || m != 0) && distance < complete_to) discs_.push_back({n, m, place, distance});
      }
    std::sort(discs_.begin(), discs_.end(),
              [](const Disc& p, const Disc& q) { return p.distance < q.distance; });
    if (discs_.empty()) return;
    widest_ = std::max(1.1 * radius_, 0.55 * area / discs_.front().distance);
    known_to_ = least_ahead(complete_to);
  }
  /// Of a disc at such a distance that may be met, or gone on from.
  double least_ahead(double distance) const {
    return std::sqrt(std::max(distance * distance - 4.0 * widest_ * widest_, 0.0)) - margin_;
  }

  /// Those of the entries from one direction and offset up to, but without, another.
  Flights flights(int quadrant, int direction, int end_direction, int offset,
                  int end_offset) const {
    const double half = 0.5 * LaneTable::disc_directions, middle = 0.5 * LaneTable::disc_offsets;
    const double largest = std::sqrt(0.5) * (1.0 + slack);
    const auto small = [&](double at) {
      return std::clamp((at - 0.5 - half) / table_.directions_per_unit, -largest, largest);
    };
    const auto aside = [&](double at) {
      return std::clamp((at - 0.5 - middle) / table_.offsets_per_length, -widest_ - margin_,
                        widest_ + margin_);
    };
    const auto unit = [&](double x) {
      const double big = std::sqrt(1.0 - x * x);
      return quadrant == 0 ? Vector{big, x} : Vector{x, big};
    };
    const double from = small(direction - slack), to = small(end_direction + slack);
    return {unit(from),
            unit(to),
            1.5 * (to - from),
            {aside(offset - slack), aside(end_offset + slack)}};
  }

  bool surely_cut(const Candidate& c) const {
    return c.side.low > -radius_ + margin_ && c.side.high < radius_ - margin_;
  }
  bool in_reach(const Candidate& c) const { return c.side.low > -widest_ && c.side.high < widest_; }
  bool before(const Candidate& p, const Candidate& q) const {
    return p.ahead.high + margin_ < q.ahead.low;
  }

  /// The discs ahead that some of these flights may cut, and those that all pass near enough to go
  /// on from, among some that stand by their distance. False: it is not certain of one that it lies
  /// ahead. What some of the flights may meet or go on from is put into `near`.
  bool look(const Flights& f, const std::vector<const Disc*>& among,
            std::vector<const Disc*>& near) {
    met_.clear();
    passed_.clear();
    bool ordered = true;
    double end = HUGE_VAL;  // behind a disc that all cut
    for (const Disc* each : among) {
      const Disc& disc = *each;
      if (least_ahead(disc.distance) > end) break;
      const Range side = f.offsets + of_sine(cross(f.from, disc.place), cross(f.to, disc.place),
                                             disc.distance, f.angle);
      if (side.low > widest_ || side.high < -widest_) continue;
      const bool may_cut = side.low < radius_ + margin_ && side.high > -radius_ - margin_;
      const Range ahead =
          of_sine(dot(f.from, disc.place), dot(f.to, disc.place), disc.distance, f.angle);
      const Candidate candidate{&disc, side, ahead};
      if (ahead.high < -margin_) continue;
      near.push_back(each);
      const bool is_ahead = ahead.low > margin_;
      if (may_cut) {
        // It may be the disc that the flight began on.
        ordered = ordered && is_ahead;
        met_.push_back(candidate);
        if (is_ahead && surely_cut(candidate)) end = std::min(end, ahead.high + margin_);
      } else if (is_ahead && in_reach(candidate)) {
        passed_.push_back(candidate);
      }
    }
    return ordered;
  }

  /// The one that comes before all others but those of `but`; null: not certain which.
  const Candidate* first_met(const Candidate* but) const {
    const Candidate* first = nullptr;
    for (const Candidate& c : met_)
      if (&c != but && (!first || c.ahead.low < first->ahead.low)) first = &c;
    for (const Candidate& c : met_)
      if (first && &c != first && &c != but && !before(*first, c)) return nullptr;
    return first;
  }
  /// The farthest one to go on from: behind `after`, and before all others that may be met.
  const Candidate* farthest_passed(const Candidate* after) const {
    double end = known_to_;
    for (const Candidate& c : met_)
      if (&c != after) end = std::min(end, c.ahead.low);
    const Candidate* best = nullptr;
    for (const Candidate& c : passed_)
      if (c.ahead.high + margin_ < end && (!after || before(*after, c)) &&
          (!best || c.ahead.low > best->ahead.low))
        best = &c;
    return best;
  }

  /// The answer that holds for all of these flights.
  std::optional<Seen> seen_by(const Flights& f, const std::vector<const Disc*>& among,
                              std::vector<const Disc*>& near) {
    if (!look(f, among, near)) return {};
    const auto seen = [](const Candidate* first, const Candidate* then) -> std::optional<Seen> {
      if (!first || !then) return {};
      return Seen{first->disc, then->disc};
    };
    const Candidate* first = first_met(nullptr);
    if (!first || !(first->ahead.high < known_to_)) {
      const Candidate* passed = farthest_passed(nullptr);
      return seen(passed, passed);
    }
    if (surely_cut(*first)) return seen(first, first);
    const Candidate* second = first_met(first);
    if (second && second->ahead.high < known_to_ && in_reach(*second)) return seen(first, second);
    if (const Candidate* passed = farthest_passed(first)) return seen(first, passed);
    return seen(first, in_reach(*first) ? first : nullptr);
  }

  /// All entries of these directions and offsets: together if they all meet a disc there, else by
  /// quarters.
  void fill(int quadrant, int direction, int end_direction, int offset, int end_offset,
            const std::vector<const Disc*>& among) {
    if (without_ > most_without) return;
    const bool single = end_direction - direction == 1 && end_offset - offset == 1;
    const Flights all = flights(quadrant, direction, end_direction, offset, end_offset);
    std::vector<const Disc*> near;
    if (const auto seen = seen_by(all, among, near); seen && (single || ends_at(*seen->then, all)))
      return enter(quadrant, direction, end_direction, offset, end_offset, *seen);
    if (single) {
      ++without_;
      return;
    }
    const auto halves = [](int from, int to, const auto& each) {
      const int middle = to - from == 1 ? to : (from + to) / 2;
      each(from, middle);
      if (middle < to) each(middle, to);
    };
    halves(direction, end_direction, [&](int d, int end_d) {
      halves(offset, end_offset,
             [&](int o, int end_o) { fill(quadrant, d, end_d, o, end_o, near); });
    });
  }
  bool ends_at(const Disc& disc, const Flights& f) const {
    return surely_cut({&disc,
                       f.offsets + of_sine(cross(f.from, disc.place), cross(f.to, disc.place),
                                           disc.distance, f.angle),
                       {}});
  }

  void enter(int quadrant, int direction, int end_direction, int offset, int end_offset,
             const Seen& seen) {
    const auto entry = [&](int q, int d, int o) -> std::uint32_t& {
      return entries_[static_cast<std::size_t>(
          (q * LaneTable::disc_directions + d) * LaneTable::disc_offsets + o)];
    };
    const auto discs = [&](int sign) {
      return LaneTable::two_discs(sign * seen.first->first, sign * seen.first->second,
                                  sign * seen.then->first, sign * seen.then->second);
    };
    const std::uint32_t number = discs(1), opposite = discs(-1);
    for (int d = direction; d < end_direction; ++d)
      for (int o = offset; o < end_offset; ++o) {
        entry(quadrant, d, o) = number;
        if (d > 0)
          entry(quadrant + 1, LaneTable::disc_directions - d, o) =
              opposite;  // no flight has direction 0
      }
  }

  LaneTable& table_;
  double radius_;
  std::vector<std::uint32_t> entries_;
  std::vector<Disc> discs_;
  std::vector<Candidate> met_, passed_;  ///< by the flights that look()
  double widest_ = 0.0;                  ///< side of a disc that is gone on from
  double known_to_ = 0.0;                ///< ahead: discs_ has all up to there
  double margin_ = 0.0;
  long without_ = 0;
};

}  // namespace

std::vector<std::uint32_t> make_next_discs(LaneTable& t) {
  if (t.edges == 0 || t.pieces != 1 || t.divided || !(t.sizes_of_radius < largest_sizes_of_radius))
    return {};
  std::vector<std::uint32_t> entries = NextDiscTable(t).make();
  if (entries.empty()) return {};
  t.next_discs = entries.data();
  t.steps = steps_to_first_disc;
  return entries;
}

}  // namespace carom::lanes
