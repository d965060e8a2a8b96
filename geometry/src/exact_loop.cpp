#include "exact_loop.hpp"

#include <cmath>

#include "carom/base/error.hpp"
#include "carom/geometry/hull.hpp"

namespace carom::geometry {

namespace {

struct Rounded {
  Vector at;
  double error;  ///< of each coordinate
};
Rounded rounded(const ExactPoint& p) {
  const double weight = p.w.approximate();
  const Vector at{p.x.approximate() / weight, p.y.approximate() / weight};
  // Three roundings or cuts, each of at most 2^-52: 4 are taken.
  return {at, 0x1p-50 * std::fmax(std::fabs(at.x), std::fabs(at.y))};
}

/// Can the ray meet the box? Wrong only on the safe side.
bool may_meet(const Rounded& origin, Vector d, const Box& box) {
  const double reach = std::fmax(std::fmax(std::fabs(box.low.x), std::fabs(box.high.x)),
                                 std::fmax(std::fabs(box.low.y), std::fabs(box.high.y)));
  const double size = std::fabs(d.x) + std::fabs(d.y);
  // A difference of coordinates, a product and a sum: 4 roundings of 2^-53 of the numbers in them;
  // 32 are taken.
  const double margin =
      size *
      (0x1p-48 * (reach + std::fabs(origin.at.x) + std::fabs(origin.at.y)) + 2.0 * origin.error);
  double low = HUGE_VAL, high = -HUGE_VAL, ahead = -HUGE_VAL;
  for (const Vector corner :
       {box.low, box.high, {box.low.x, box.high.y}, {box.high.x, box.low.y}}) {
    const Vector e = corner - origin.at;
    low = std::fmin(low, cross(d, e));
    high = std::fmax(high, cross(d, e));
    ahead = std::fmax(ahead, dot(d, e));
  }
  return low <= margin && high >= -margin && ahead >= -margin;
}

DyadicVector direction(int number) {
  // Any directions will do; these are seldom those of a table's joints.
  const double slope = 0.1123046875 + 0.2939453125 * number;
  return number % 2 == 0 ? exact(Vector{1.0, slope}) : exact(Vector{-slope, 1.0});
}

constexpr int directions = 200;

}  // namespace

Box moved(const Box& box, Vector by) {
  const auto down = [](double v) { return std::nextafter(v, -HUGE_VAL); };
  const auto up = [](double v) { return std::nextafter(v, HUGE_VAL); };
  // The translation is itself cut, by less than its last bit, which is 2^-52 of it at most (or the
  // smallest double, which a step down or up covers). The sum and the difference are each rounded
  // by half a step at most: one step for each.
  const double dx = 0x1p-52 * std::fabs(by.x), dy = 0x1p-52 * std::fabs(by.y);
  return {{down(down(box.low.x + by.x) - dx), down(down(box.low.y + by.y) - dy)},
          {up(up(box.high.x + by.x) + dx), up(up(box.high.y + by.y) + dy)}};
}

ExactLoop::ExactLoop(const Loop& loop, const DyadicVector& shift) {
  const bool here = shift.x.sign() == 0 && shift.y.sign() == 0;
  const Vector by{shift.x.approximate(), shift.y.approximate()};
  pieces_.reserve(loop.size());
  for (const NamedCurve& c : loop) {
    pieces_.emplace_back(c.curve, shift);
    const Box box = bounding_box(c.curve);
    boxes_.push_back(here ? box : moved(box, by));
    const Box& b = boxes_.back();
    if (boxes_.size() == 1) whole_ = b;
    whole_ = {{std::fmin(whole_.low.x, b.low.x), std::fmin(whole_.low.y, b.low.y)},
              {std::fmax(whole_.high.x, b.high.x), std::fmax(whole_.high.y, b.high.y)}};
  }
}

bool ExactLoop::on_boundary(const ExactPoint& point) const {
  const Rounded at = rounded(point);
  const Box box{{at.at.x - at.error, at.at.y - at.error}, {at.at.x + at.error, at.at.y + at.error}};
  for (std::size_t i = 0; i < size(); ++i)
    if (overlap(box, boxes_[i]) &&
        (pieces_[i].curve().bezier()
             ? passes_through(pieces_[i].stretches().front(), point)
             : pieces_[i].side(point) == 0 && pieces_[i].where(point) != Where::outside))
      return true;
  return false;
}

namespace {

/// 1, 0: the ray crosses the segment or not; -1: it passes through an end of it.
int crosses_segment(const ExactCurve& c, const ExactPoint& origin, const DyadicVector& d,
                    bool own) {
  const auto seen = [&](const DyadicVector& p) {
    return DyadicVector{p.x * origin.w - origin.x, p.y * origin.w - origin.y};
  };
  const DyadicVector a = seen(c.from), b = seen(c.to);
  const int from = cross(d, a).sign(), to = cross(d, b).sign();
  // Its start is left to the piece that ends there.
  if (to == 0 && dot(d, b).sign() >= 0) return -1;
  if (from * to >= 0) return 0;
  const int ahead = to * cross(a, c.direction).sign();
  if (ahead == 0) return own ? 0 : -1;
  return ahead > 0 ? 1 : 0;
}

}  // namespace

int ExactLoop::crossings(const ExactPoint& origin, const DyadicVector& d, std::size_t own) const {
  const Rounded at = rounded(origin);
  const Vector along{d.x.approximate(), d.y.approximate()};
  int count = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (!may_meet(at, along, boxes_[i])) continue;
    const ExactPiece& piece = pieces_[i];
    if (piece.curve().segment) {
      const int crossed = crosses_segment(piece.curve(), origin, d, i == own);
      if (crossed < 0) return -1;
      count += crossed;
      continue;
    }
    for (std::size_t k = 0; k < piece.stretches().size(); ++k) {
      const Stretch& s = piece.stretches()[k];
      const Polynomial across = form_along(s, left(d), origin);
      const Polynomial ahead = form_along(s, d, origin);
      for (const RealRoot& root : roots_in_unit(across)) {
        const Where where = piece.where_along(k, root.value);
        if (where == Where::outside) continue;
        const int side = sign_at(ahead, root.value);
        if (side < 0 || (side == 0 && i == own)) continue;
        if (side == 0 || where != Where::inside || root.multiplicity != 1) return -1;
        ++count;
      }
    }
  }
  return count;
}

bool ExactLoop::inside(const ExactPoint& point) const {
  for (int i = 0; i < directions; ++i) {
    const int count = crossings(point, direction(i), size());
    if (count >= 0) return count % 2 != 0;
  }
  throw InternalError("no ray in general position");
}

bool ExactLoop::counterclockwise() const {
  if (pieces_[0].curve().closed) return pieces_[0].curve().orientation > 0;
  // From a point within the first piece, to the left: an odd number of crossings leads outside.
  const ExactCurve& first = pieces_[0].curve();
  const double at = sample_parameter(pieces_[0].end(), 1);
  const ExactPoint from = first.point(at);
  const DyadicVector tangent = first.direction_at(at);
  for (int i = 0; i < directions; ++i) {
    DyadicVector d = direction(i);
    const int side = cross(tangent, d).sign();
    if (side == 0) continue;
    if (side < 0) d = -d;
    const int count = crossings(from, d, 0);
    if (count >= 0) return count % 2 != 0;
  }
  throw InternalError("no ray in general position");
}

double sample_parameter(double end, int n) {
  // With few bits, well within the curve: a power of two below its end, or parts of it.
  int exponent = 0;
  std::frexp(end, &exponent);
  return std::ldexp(n % 2 != 0 ? 0.5 : 0.375, exponent - 1 - n / 2);
}

ExactPoint sample_point(const ExactCurve& c, double end, int n) {
  if (n == 0) return {c.from.x, c.from.y, Dyadic(1)};
  return c.point(sample_parameter(end, n));
}

}  // namespace carom::geometry
