// A Larmor circle against an ellipse: places where the flight leaves the domain, in their order, as
// roots of a form of degree four (three from the ellipse itself) in (p, q), kappa = p/q. Descartes'
// rule in Bernstein form isolates them, so that none is missed; Newton's steps over enclosures make
// them narrow.
#pragma once

#include <array>
#include <optional>

#include "carom/geometry/bernstein.hpp"
#include "certify/flight/larmor_circle.hpp"
#include "certify/flight/next_wall.hpp"

namespace carom::certify {

/// Sum of q[i] kappa^i, positive on the domain's side.
template <class N>
struct LarmorForm {
  std::array<N, 5> q{};
  std::size_t degree = 4;
};

template <class N, class C>
LarmorForm<N> larmor_form(const WallOf<C>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                          const MotionOf<C>& motion, bool standing) {
  const auto image = [&w](const VectorOf<N>& d) {
    return VectorOf<N>{dot2(d, w.along), dot2(d, w.across)};
  };
  const VectorOf<N> e = image(minus(P, w.centre)), u = image(v), turned = image(right(v));
  const C& h = motion.half_omega;
  const C n = square(h), omega = h + h;
  const N eu = e.x * u.x + e.y * u.y, e_turned = omega * (e.x * turned.x + e.y * turned.y);
  LarmorForm<N> f;
  f.q[3] = eu + eu;
  f.q[2] = e_turned + (square(u.x) + square(u.y));
  f.q[1] = n * f.q[3] + omega * (u.x * turned.x + u.y * turned.y);
  f.q[0] = e_turned + (square(turned.x) + square(turned.y));
  if (standing) {
    f.degree = 3;
  } else {
    f.q[4] = (square(e.x) + square(e.y)) - C(1);
    const N more = n * f.q[4];
    f.q[2] = f.q[2] + (more + more);
    f.q[0] = f.q[0] + more;
  }
  f.q[0] = n * f.q[0];
  if (w.turn > 0)
    for (N& q : f.q) q = -q;
  return f;
}

// Isolation needs one operation besides + - * /: a number that contains two others.
template <class N>
N union_of(const N& a, const N& b) {
  return N(0.5) * (a + b);
}
inline Interval union_of(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}
inline Ball union_of(const Ball& a, const Ball& b) {
  return made<Ball>(arb_union, a.raw(), b.raw(), Precision::bits());
}

/// The way of (p, q) along a Larmor circle in three straight pieces, s from 0 to 1 in each. p is in
/// units of a typical kappa; the pieces' ends are not at places that a simple start could lead to.
struct LarmorChord {
  double p, p_step, q, q_step;
};
inline constexpr std::array<LarmorChord, 3> larmor_chords{
    {{1.1875, 0.0, 0.0, 1.0}, {1.1875, -2.25, 1.0, 0.0}, {-1.0625, 0.0, 1.0, -1.0}}};

/// A polynomial in s, by powers.
template <class N>
struct Powers {
  std::array<N, 5> c{};
  std::size_t degree = 4;

  N at(const N& s) const {
    N r = c[degree];
    for (std::size_t i = degree; i-- > 0;) r = r * s + c[i];
    return r;
  }
  N slope_at(const N& s) const {
    N r = N(static_cast<double>(degree)) * c[degree];
    for (std::size_t i = degree; i-- > 1;) r = r * s + N(static_cast<double>(i)) * c[i];
    return r;
  }
};

/// The form along a chord. The coefficients of p^i q^(degree - i) are exact in doubles.
template <class N>
Powers<N> along_chord(const LarmorForm<N>& f, const LarmorChord& chord) {
  Powers<N> r;
  r.degree = f.degree;
  for (std::size_t i = 0; i <= f.degree; ++i) {
    std::array<double, 5> product{1.0, 0.0, 0.0, 0.0, 0.0};
    for (std::size_t k = 0; k < f.degree; ++k) {
      const double a = k < i ? chord.p : chord.q, b = k < i ? chord.p_step : chord.q_step;
      for (std::size_t j = f.degree; j > 0; --j) product[j] = a * product[j] + b * product[j - 1];
      product[0] *= a;
    }
    for (std::size_t j = 0; j <= f.degree; ++j)
      if (product[j] != 0.0) r.c[j] = r.c[j] + N(product[j]) * f.q[i];
  }
  return r;
}

/// Where the flight leaves the domain: one root between low and high. Or, not certain: it may leave
/// there or anywhere later.
template <class N>
struct LarmorExit {
  bool certain = false;
  std::size_t chord = 0;
  N low{}, high{};
  N slope{};  ///< the derivative over the bracket times its length
};

/// Halvings that isolation is given, and the precision: balls get more in every attempt.
template <class N>
struct IsolationEffort {
  int deepest = 50;
};
template <>
struct IsolationEffort<Ball> {
  int deepest = static_cast<int>(std::min<slong>(Precision::bits(), 128 + Precision::bits() / 16));
  Precision precision{deepest};
};

/// The exits of a flight, in their order; the last one may be uncertain.
template <class N>
class LarmorExits {
 public:
  /// Stops after `most`.
  LarmorExits(const std::array<Powers<N>, 3>& chords, std::size_t most) : most_(most) {
    const IsolationEffort<N> effort;
    deepest_ = effort.deepest;
    for (chord_ = 0; chord_ < chords.size(); ++chord_)
      if (!isolate(bernstein(chords[chord_]), N(0.0), N(1.0), true, 0,
                   [this](const BernsteinPolynomial& p, const N& low, const N& high, int depth) {
                     return look(p, low, high, depth);
                   }))
        return;
  }
  const LarmorExit<N>* begin() const { return exits_.data(); }
  const LarmorExit<N>* end() const { return exits_.data() + count_; }

 private:
  using BernsteinPolynomial = geometry::BernsteinPolynomial<N>;

  static BernsteinPolynomial bernstein(const Powers<N>& f) {
    return geometry::bernstein_form(f.c, f.degree, [](const N& c, int m, int n) {
      return n == 1 ? c : N(static_cast<double>(m)) * c / N(static_cast<double>(n));
    });
  }

  /// True if more is asked for.
  bool take(LarmorExit<N> exit) {
    exits_[count_++] = std::move(exit);
    return count_ < most_ && exits_[count_ - 1].certain;
  }

  /// Nothing: the piece must be halved.
  std::optional<bool> look(const BernsteinPolynomial& p, const N& low, const N& high, int depth) {
    const geometry::SignChanges roots =
        geometry::sign_changes(p, [](const N& x) { return sign(x); });
    if (roots.certain && roots.most == 0) return true;
    if (roots.certain && roots.most == 1) {
      if (roots.first == Sign::negative) return true;  // the flight enters there
      bool falls = true;
      N slope = p.b[1] - p.b[0];
      double least = HUGE_VAL, most = 0.0;
      for (std::size_t k = 0; k < p.degree; ++k) {
        const N step = p.b[k + 1] - p.b[k];
        falls = falls && sign(step) == Sign::negative;
        slope = union_of(slope, step);
        const double size = std::fabs(middle_of(step));
        least = std::min(least, size);
        most = std::max(most, size);
      }
      // Then the first of Newton's steps makes the bracket four times as narrow.
      if (falls && (most < 1.5 * least || depth == deepest_))
        return take({true, chord_, low, high, N(static_cast<double>(p.degree)) * slope});
    }
    if (depth == deepest_) return take({false, chord_, low, high, {}});
    return std::nullopt;
  }

  std::size_t most_, chord_ = 0, count_ = 0;
  int deepest_ = 50;
  std::array<LarmorExit<N>, 5> exits_{};
};

/// The root of a certain exit, by Newton's steps; over enclosures:
Interval narrowed(const Powers<Interval>&, const LarmorExit<Interval>&);
Ball narrowed(const Powers<Ball>&, const LarmorExit<Ball>&);
/// In numbers that are taken at their word.
template <class N>
N narrowed(const Powers<N>& f, const LarmorExit<N>& exit) {
  const N half(0.5);
  N low = exit.low, high = exit.high, s = half * (low + high);
  for (int step = 0; step < 8; ++step) {
    (sign(f.at(s)) == Sign::positive ? low : high) = s;
    s = half * (low + high);
  }
  for (int step = 0; step < 12; ++step) {
    const N change = f.at(s) / f.slope_at(s);
    if (sign(change) == Sign::zero) break;
    s = s - change;
  }
  return s;
}

/// A flight against an ellipse.
template <class N>
class EllipseFlight {
 public:
  /// `size`: |image of v|, in doubles.
  EllipseFlight(const LarmorForm<N>& form, double size)
      : scale_(std::ldexp(1.0, std::ilogb(size))) {
    LarmorForm<N> f = form;
    double power = 1.0;
    for (std::size_t i = 1; i <= f.degree; ++i) {
      power *= scale_;
      f.q[i] = N(power) * f.q[i];
    }
    for (std::size_t k = 0; k < 3; ++k) chords_[k] = along_chord(f, larmor_chords[k]);
  }
  const std::array<Powers<N>, 3>& chords() const { return chords_; }
  double scale() const { return scale_; }

  Kappa<N> place(std::size_t chord, const N& s) const { return place_of<N>(chord, s, scale_); }
  Kappa<N> place(const LarmorExit<N>& exit) const {
    return place(exit.chord, exit.certain ? narrowed(chords_[exit.chord], exit)
                                          : union_of(exit.low, exit.high));
  }
  template <class M>
  static Kappa<M> place_of(std::size_t chord, const M& s, double scale) {
    const LarmorChord& c = larmor_chords[chord];
    return {N(scale * c.p_step) * s + N(scale * c.p), N(c.q_step) * s + N(c.q)};
  }

 private:
  double scale_;
  std::array<Powers<N>, 3> chords_;
};

/// A typical kappa of flights across an ellipse.
template <class C>
double kappa_scale(const WallOf<C>& w, const VectorOf<C>& v, const C& h) {
  const double x = middle_of(dot(v, w.along)), y = middle_of(dot(v, w.across));
  return std::max(std::sqrt(x * x + y * y), std::fabs(middle_of(h)));
}

/// The first exit on the wall: its chord and s. Unknown where an exit before it may lie on the wall
/// too, or it itself beside the wall: the next one must not be taken for it.
template <class N>
struct EllipsePlace {
  std::size_t chord = 0;
  N s = N(1.0) / N(0.0);  ///< unknown
};
template <class N>
EllipsePlace<N> ellipse_place(const EllipseFlight<N>& flight, const WallOf<N>& w,
                              const VectorOf<N>& P, const VectorOf<N>& v, const N& h) {
  for (const LarmorExit<N>& exit : LarmorExits<N>(flight.chords(), w.closed ? 1 : 5)) {
    if (!exit.certain) break;
    const N s = narrowed(flight.chords()[exit.chord], exit);
    const Verdict on_wall =
        on_arc(w, larmor_state<N, N>(flight.place(exit.chord, s), P, v, h).position);
    if (on_wall == Verdict::yes) return {exit.chord, s};
    if (on_wall == Verdict::undecided) break;
  }
  return {};
}

template <class N>
Kappa<N> ellipse_exit(const WallOf<N>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                      const MotionOf<N>& motion, bool standing) {
  const N& h = motion.half_omega;
  const EllipseFlight<N> flight(larmor_form<N, N>(w, P, v, motion, standing), kappa_scale(w, v, h));
  const EllipsePlace<N> found = ellipse_place(flight, w, P, v, h);
  return flight.place(found.chord, found.s);
}

/// With derivatives: of the root s of f(s), ds = -df/f'.
template <class N>
Kappa<Dual<N>> ellipse_exit(const WallOf<N>& w, const VectorOf<Dual<N>>& P,
                            const VectorOf<Dual<N>>& v, const MotionOf<N>& motion, bool standing) {
  const LarmorForm<Dual<N>> form = larmor_form<Dual<N>, N>(w, P, v, motion, standing);
  LarmorForm<N> values;
  values.degree = form.degree;
  for (std::size_t i = 0; i < 5; ++i) values.q[i] = form.q[i].value;
  const VectorOf<N> P0{P.x.value, P.y.value}, v0{v.x.value, v.y.value};
  const N& h = motion.half_omega;
  const EllipseFlight<N> flight(values, kappa_scale(w, v0, h));
  const EllipsePlace<N> found = ellipse_place(flight, w, P0, v0, h);
  const N slope = flight.chords()[found.chord].slope_at(found.s);
  const Dual<N> s = Dual<N>::each(found.s, [&](std::size_t i) {
    LarmorForm<N> change;
    change.degree = form.degree;
    for (std::size_t k = 0; k < 5; ++k) change.q[k] = form.q[k].slope[i];
    return -(EllipseFlight<N>(change, flight.scale()).chords()[found.chord].at(found.s) / slope);
  });
  return EllipseFlight<N>::template place_of<Dual<N>>(found.chord, s, flight.scale());
}

}  // namespace carom::certify
