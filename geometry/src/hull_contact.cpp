#include "hull_contact.hpp"

#include <algorithm>
#include <cmath>

#include "carom/geometry/bernstein.hpp"

namespace carom::geometry {

namespace {

/// Pairs that are looked at before two pieces are taken to meet, and how often each is halved. A
/// part is then 2^-40 of its piece, so what is nearer is nearer than rounding places hits.
constexpr int most_pairs = 20000, deepest = 40;

/// A part of a curve by control points, weights positive.
struct Part {
  std::vector<ExactPoint> control;
  std::vector<Vector> rounded;

  explicit Part(std::vector<ExactPoint> points) : control(std::move(points)) {
    for (const ExactPoint& p : control) {
      const double w = p.w.approximate();
      rounded.push_back({p.x.approximate() / w, p.y.approximate() / w});
    }
  }
  Vector chord() const { return rounded.back() - rounded.front(); }
  Vector middle() const { return 0.5 * (rounded.front() + rounded.back()); }
};

struct Halved {
  Part first, second;
};
Halved halved(const Part& part) {
  std::vector<ExactPoint> right = part.control, left;
  const Dyadic half(0.5);
  const auto mean = [&](const Dyadic& a, const Dyadic& b) { return half * (a + b); };
  for (std::size_t n = right.size(); n > 0; --n) {
    left.push_back(right[0]);
    for (std::size_t k = 0; k + 1 < n; ++k)
      right[k] = {mean(right[k].x, right[k + 1].x), mean(right[k].y, right[k + 1].y),
                  mean(right[k].w, right[k + 1].w)};
  }
  return {Part(std::move(left)), Part(std::move(right))};
}

Part part_of(const Stretch& s) {
  const std::size_t degree =
      std::max({s.x.size(), s.y.size(), s.weight.size(), std::size_t{2}}) - 1;
  const auto form = [&](Polynomial p) {
    p.resize(degree + 1);
    return bernstein_form<Bezier::most>(
        p, degree, [](const Dyadic& c, int m, int n) { return Dyadic(60 * m / n) * c; });
  };
  const auto x = form(s.x), y = form(s.y), w = form(s.weight);
  std::vector<ExactPoint> control;
  for (std::size_t i = 0; i <= degree; ++i) control.push_back({x.b[i], y.b[i], w.b[i]});
  return Part(std::move(control));
}

int side(const DyadicVector& direction, const DyadicVector& origin, const ExactPoint& p) {
  return cross(direction, DyadicVector{p.x - p.w * origin.x, p.y - p.w * origin.y}).sign();
}
bool all_on_side(const Part& part, const DyadicVector& direction, const DyadicVector& origin,
                 int wanted) {
  return std::all_of(part.control.begin(), part.control.end(),
                     [&](const ExactPoint& p) { return side(direction, origin, p) == wanted; });
}

/// Does a line along `direction` separate two parts? It is sought in doubles, and then decides
/// exactly.
bool separated(const Part& a, const Part& b, Vector direction) {
  double reach[2][2] = {{HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}};
  Vector extreme[2][2];
  const Part* parts[] = {&a, &b};
  for (int k = 0; k < 2; ++k)
    for (const Vector& p : parts[k]->rounded) {
      const double s = cross(direction, p - a.rounded[0]);
      if (s < reach[k][0]) {
        reach[k][0] = s;
        extreme[k][0] = p;
      }
      if (s > reach[k][1]) {
        reach[k][1] = s;
        extreme[k][1] = p;
      }
    }
  const bool a_left = reach[0][0] > reach[1][1], b_left = reach[1][0] > reach[0][1];
  if (!a_left && !b_left) return false;
  const Vector origin =
      a_left ? 0.5 * (extreme[0][0] + extreme[1][1]) : 0.5 * (extreme[0][1] + extreme[1][0]);
  const DyadicVector d = exact(direction), o = exact(origin);
  return all_on_side(a, d, o, a_left ? 1 : -1) && all_on_side(b, d, o, a_left ? -1 : 1);
}
bool apart(const Part& a, const Part& b) {
  const Vector between = b.middle() - a.middle();
  return separated(a, b, left(between)) || separated(a, b, a.chord()) ||
         separated(a, b, b.chord()) || separated(a, b, {1.0, 0.0}) || separated(a, b, {0.0, 1.0});
}

/// q - p, times a positive factor.
DyadicVector way(const ExactPoint& p, const ExactPoint& q) {
  return {q.x * p.w - p.x * q.w, q.y * p.w - p.y * q.w};
}
bool is_zero(const DyadicVector& v) { return v.x.sign() == 0 && v.y.sign() == 0; }

/// The first ends where the second begins: does a line through that point along d have all else of
/// one on its left, all else of the other on its right? Control points may lie on the line, their
/// far ends excepted: these have a share in every point but the joint.
bool on_two_sides(const Part& first, const Part& second, const DyadicVector& d) {
  const ExactPoint& joint = second.control[0];
  const auto side = [&](const ExactPoint& p) { return cross(d, way(joint, p)).sign(); };
  const int one = side(first.control.front()), other = side(second.control.back());
  return one * other < 0 &&
         std::all_of(first.control.begin(), first.control.end(),
                     [&](const ExactPoint& p) { return side(p) * one >= 0; }) &&
         std::all_of(second.control.begin(), second.control.end(),
                     [&](const ExactPoint& p) { return side(p) * other >= 0; });
}
bool apart_but_at_joint(const Part& first, const Part& second) {
  // The direction at an end is that to the next control point elsewhere.
  const std::size_t n = first.control.size();
  std::size_t before = n - 1, after = 1;
  while (before > 1 && is_zero(way(first.control[before - 1], first.control[n - 1]))) --before;
  while (after + 1 < second.control.size() &&
         is_zero(way(second.control[0], second.control[after])))
    ++after;
  const auto unit = [](Vector v) { return (1.0 / std::sqrt(dot(v, v))) * v; };
  const Vector comes = unit(first.rounded[n - 1] - first.rounded[before - 1]),
               goes = unit(second.rounded[after] - second.rounded[0]);
  // Across the way through a joint; along it in a cusp. Far from the origin parts are shorter than
  // the rounding of their places.
  const Vector across = left(comes + goes);
  return (std::isfinite(across.x) && std::isfinite(across.y) &&
          on_two_sides(first, second, exact(across))) ||
         on_two_sides(first, second, way(second.control[0], second.control[after]));
}

class Search {
 public:
  std::optional<Vector> meet(const Part& a, const Part& b, SharedEnds shared, int depth) {
    if (depth == deepest || ++pairs_ > most_pairs) return 0.5 * (a.middle() + b.middle());
    if (shared.forth != shared.back) {
      if (shared.forth ? apart_but_at_joint(a, b) : apart_but_at_joint(b, a)) return std::nullopt;
    } else if (!shared.forth && apart(a, b)) {
      return std::nullopt;
    }
    const Halved p = halved(a), q = halved(b);
    if (auto at = meet(p.first, q.first, {}, depth + 1)) return at;
    if (auto at = meet(p.first, q.second, {false, shared.back}, depth + 1)) return at;
    if (auto at = meet(p.second, q.first, {shared.forth, false}, depth + 1)) return at;
    return meet(p.second, q.second, {}, depth + 1);
  }
  /// A part whose tangents all point less than a right angle off its chord does not meet itself.
  std::optional<Vector> meet_itself(const Part& a, bool closed, int depth) {
    if (depth == deepest || ++pairs_ > most_pairs) return a.middle();
    if (!closed && runs_along_chord(a)) return std::nullopt;
    const Halved p = halved(a);
    if (auto at = meet_itself(p.first, false, depth + 1)) return at;
    if (auto at = meet_itself(p.second, false, depth + 1)) return at;
    return meet(p.first, p.second, {true, closed}, depth + 1);
  }

 private:
  static bool runs_along_chord(const Part& a) {
    const DyadicVector chord = exact(a.chord());
    bool runs = false;  // somewhere, so everywhere between the ends
    for (std::size_t i = 0; i + 1 < a.control.size(); ++i) {
      const int sign = dot(chord, way(a.control[i], a.control[i + 1])).sign();
      if (sign < 0) return false;
      runs = runs || sign > 0;
    }
    return runs;
  }
  int pairs_ = 0;
};

}  // namespace

std::optional<Vector> meeting(const ExactPiece& first, const ExactPiece& second,
                              SharedEnds shared) {
  Search search;
  const std::vector<Stretch> a = first.whole_stretches(), b = second.whole_stretches();
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k)
      if (auto at = search.meet(part_of(a[i]), part_of(b[k]),
                                {shared.forth && i + 1 == a.size() && k == 0,
                                 shared.back && i == 0 && k + 1 == b.size()},
                                0))
        return at;
  return std::nullopt;
}

std::optional<Vector> meeting_with_itself(const ExactPiece& piece, bool closed) {
  return Search().meet_itself(part_of(piece.stretches().front()), closed, 0);
}

}  // namespace carom::geometry
