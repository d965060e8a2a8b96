// The first exit of a flight through a Bézier curve, of any path that gives its side as a
// polynomial in u: `Path` is a line or a Larmor circle (bezier_flight.cpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "carom/geometry/bernstein.hpp"
#include "carom/geometry/bezier_flight.hpp"
#include "number_with_error.hpp"

namespace carom::geometry {

/// A polynomial in u and its derivative.
struct Local {
  double value, slope;
};

/// Does the side of a flight rise from one coefficient in Bernstein form to the next, or fall, each
/// time by more than what could hide one of them? (Positive: it rises.) Its values at both ends,
/// and what they err by at most.
struct Course {
  Sign trend = Sign::undecided;
  double first, last, error;
};

/// The exit at the one root in [from, to], where the sign changes between the values `first` and
/// `last`. Negative: the flight does not leave there.
CurveExit exit_between(const auto& path, double first, double last, double from, double to,
                       bool rises) {
  const double error = path.error(), before = rises ? -1.0 : 1.0;
  double low = from, high = to, slope = 0.0;
  double u = from + (to - from) * (first / (first - last));
  for (int i = 0; i < 100; ++i) {
    const Local here = path.at(u);
    slope = here.slope;
    if (here.value == 0.0) break;
    // Chosen without a branch: a processor cannot guess the side.
    const bool root_is_above = before * here.value > 0.0;
    low = root_is_above ? u : low;
    high = root_is_above ? high : u;
    double next = u - here.value / here.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::fabs(next - u);
    u = next;
    if (step <= 0x1p-52 * u) break;  // wherever it stops: signs about it decide below
  }
  // Outwards until the signs are certain: then the root is between. The slope is that of the last
  // step, close by: any width would do to begin with.
  double width = 2.0 * error / std::fabs(slope) + 4.0 * unit_roundoff;
  for (;; width *= 4.0) {
    low = std::max(from, u - width);
    high = std::min(to, u + width);
    const bool starts = low == from || before * path.value(low) > error,
               ends = high == to || -before * path.value(high) > error;
    if (starts && ends) break;
    if (!(width < 1.0)) return {};
  }
  // Along a wall that is grazed the place is hidden by rounding: the exact stage gives it. Both
  // stages decide by signs that are certain, so that the bound chooses the stage alone:
  // with it u is off by 2^-24 of the piece at most.
  const double spread = std::max(u - low, high - u);
  if (spread > 0x1p-24) return {};
  if (path.on_curve()) {
    // Beyond the start a root is left through where the quotient by u - on rises, before it where
    // that falls.
    if (low <= path.on() && high >= path.on()) return {};
    if (rises != (u > path.on())) return {.leaves = Sign::negative};
  }
  return path.exit_at(u, spread);
}

/// Isolates the roots of a flight's side and keeps the first exit.
template <class Path>
class Search {
 public:
  explicit Search(const Path& path) : path_(path) {}

  CurveExit first() {
    found_.leaves = Sign::negative;
    const bool decided = isolate(path_.bernstein(), 0.0, 1.0, true, 0,
                                 [this](const auto& p, double from, double to, int depth) {
                                   return this->look(p, from, to, depth);
                                 });
    if (!decided) found_.leaves = Sign::undecided;
    return found_;
  }

 private:
  std::optional<bool> look(const auto& p, double from, double to, int depth) {
    const SignChanges roots = sign_changes(p, [](const NumberWithError& x) { return x.sign(); });
    if (roots.first == Sign::undecided || roots.last == Sign::undecided) return false;
    if (roots.most == 0) return true;
    if (roots.least == 1 && roots.most == 1) {
      const bool rises = roots.first == Sign::negative;
      if (!rises && !path_.on_curve()) return true;
      return add(exit_between(path_, p.b[0].value, p.b[p.degree].value, from, to, rises));
    }
    constexpr int deepest = 40;
    if (depth == deepest) return false;
    return std::nullopt;
  }
  bool add(const CurveExit& exit) {
    if (exit.leaves != Sign::positive) return exit.leaves == Sign::negative;
    if (found_.leaves == Sign::positive) {
      if (!(std::fabs(exit.place - found_.place) > exit.error + found_.error)) return false;
      if (Path::is_before(found_.place, exit.place)) return true;
    }
    found_ = exit;
    return true;
  }

  const Path& path_;
  CurveExit found_;
};

/// A flight that does not start on the curve and crosses it nowhere nearly along it, as nearly all
/// do that come to a short one. The coefficients in Bernstein form rise or fall by so much that one
/// of them at most is hidden by its error: the search finds one root at once, or none, and from the
/// signs at the ends it is known which. Undecided: it is for the search to tell.
CurveExit exit_across(const auto& path) {
  if (path.on_curve()) return {};
  const Course g = path.course();
  if (g.trend == Sign::undecided) return {};
  const Sign first = sign_within(g.first, g.error), last = sign_within(g.last, g.error);
  if (first == Sign::undecided || last == Sign::undecided) return {};
  if (g.trend == Sign::negative || first == last) return {.leaves = Sign::negative};
  if (first != Sign::negative || last != Sign::positive) return {};
  return exit_between(path, g.first, g.last, 0.0, 1.0, true);
}

/// One variable from there to the caller: numbers stored one by one and copied two at once would
/// wait for each other.
CurveExit first_exit_of(const auto& path) {
  CurveExit exit = exit_across(path);
  if (exit.leaves == Sign::undecided) {
    if (path.surely_missed())
      exit.leaves = Sign::negative;
    else
      exit = Search(path).first();
  }
  return exit;
}

}  // namespace carom::geometry
