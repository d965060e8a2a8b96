#include "carom/geometry/exact_flight.hpp"

#include <optional>
#include <utility>

#include "carom/base/error.hpp"
#include "exact_flight_data.hpp"

namespace carom::geometry {

ExactFlight::ExactFlight(const ExactBoundary& boundary, int piece, double u, Vector point,
                         Vector velocity, double omega)
    : data_(new Data{boundary.data(), {}, exact(velocity), Dyadic(omega), u}) {
  if (piece >= 0) {
    data_->start = data_->curve(piece).point(u);
    const DyadicVector t =
        data_->boundary.translation(data_->boundary.pieces[static_cast<std::size_t>(piece)].offset);
    data_->start.x = data_->start.x + data_->start.w * t.x;
    data_->start.y = data_->start.y + data_->start.w * t.y;
  } else {
    data_->start = {Dyadic(point.x), Dyadic(point.y), Dyadic(1)};
  }
}
ExactFlight::~ExactFlight() = default;

bool ExactFlight::Data::segment_crossed_twice(const ExactCurve& c, const View& s,
                                              int side_of_joints,
                                              const Quadratic<Dyadic>& f) const {
  // Both ends outside the Larmor circle, the foot of its centre between them, the line cut.
  if (omega.sign() == 0 || side_of_joints * omega.sign() < 0) return false;
  return discriminant_of(f).sign() > 0 && foot_between_ends(c, s);
}

bool ExactFlight::Data::foot_between_ends(const ExactCurve& c, const View& s) const {
  if (omega.sign() == 0) return false;
  const DyadicVector from{s.x - s.w * c.from.x, s.y - s.w * c.from.y};
  const DyadicVector to{s.x - s.w * c.to.x, s.y - s.w * c.to.y};
  const Dyadic common = s.w * cross(c.direction, v);
  return (omega * dot(from, c.direction) + common).sign() * omega.sign() > 0 &&
         (omega * dot(to, c.direction) + common).sign() * omega.sign() < 0;
}

std::vector<Crossing> ExactFlight::Data::exits(int piece, Cell cell, bool starts_here,
                                               bool ends_here, bool start_at_joint,
                                               std::vector<int>* zero_joints) const {
  const ExactCurve& c = curve(piece);
  const View s = view(piece, cell);
  std::vector<Crossing> found;
  if (c.bezier()) {
    const int from = side(s, {c.from.x, c.from.y, Dyadic(1)});
    if (zero_joints && from == 0 && !(starts_here && start_at_joint)) zero_joints->push_back(piece);
    return geometry::exits(at_curve(c, s, starts_here, ends_here));
  }
  const bool on_it = starts_here || ends_here;
  if (needs_quartic(c)) {
    if (zero_joints && !c.closed && !(starts_here && start_at_joint) &&
        side(s, {c.from.x, c.from.y, Dyadic(1)}) == 0)
      zero_joints->push_back(piece);
    for (AlgebraicRoot& root : rising_roots(quartic(c, s))) {
      Crossing k;
      k.root = std::move(root);
      const ExactPoint a{c.from.x, c.from.y, Dyadic(1)}, b{c.to.x, c.to.y, Dyadic(1)};
      if (c.closed || on_part(c, s, a, b, k)) found.push_back(std::move(k));
    }
    return found;
  }
  const Quadratic<Dyadic> f = quadratic(c, s);
  std::optional<Crossing> exit;
  if (c.closed) {
    exit = quadratic_crossing(f);
  } else {
    // A particle on the joint has it on the left where its wall begins and on the right
    // where its wall ends: so the wall that it is on is entered there.
    int from = 1, to = -1;
    if (!(starts_here && start_at_joint)) {
      from = side(s, {c.from.x, c.from.y, Dyadic(1)});
      if (from == 0 && zero_joints) zero_joints->push_back(piece);
      if (from == 0) from = 1;
    }
    if (!ends_here) {
      to = side(s, c.end_point());
      if (to == 0) to = 1;
    }
    if (from < 0 && to > 0) {
      exit = quadratic_crossing(f);
      // A crossing exactly through both joints' tie rule may be a touch: then nothing is crossed.
    } else if (from == to) {
      if (on_it) {
        exit = quadratic_crossing(f);
      } else if (c.segment) {
        if (segment_crossed_twice(c, s, from, f)) exit = quadratic_crossing(f);
      } else {
        exit = quadratic_crossing(f);
        const ExactPoint a{c.from.x, c.from.y, Dyadic(1)};
        if (exit && !on_part(c, s, a, c.end_point(), *exit)) exit.reset();
      }
    }
  }
  if (exit && (omega.sign() != 0 || sign_of_kappa(*exit) > 0)) found.push_back(std::move(*exit));
  return found;
}

/// Where the flight is tangent to a piece without crossing it.
std::vector<Crossing> ExactFlight::Data::touches(int piece, Cell cell, bool starts_here,
                                                 bool ends_here) const {
  const ExactCurve& c = curve(piece);
  const View s = view(piece, cell);
  if (c.bezier()) return geometry::touches(at_curve(c, s, starts_here, ends_here));
  const ExactPoint a{c.from.x, c.from.y, Dyadic(1)};
  std::vector<Crossing> found;
  if (needs_quartic(c)) {
    for (RealRoot& root : real_roots(quartic(c, s))) {
      if (root.multiplicity % 2 != 0) continue;
      Crossing k;
      k.root = std::move(root.value);
      if (c.closed || on_part(c, s, a, c.end_point(), k)) found.push_back(std::move(k));
    }
    return found;
  }
  if (c.segment && !foot_between_ends(c, s)) return found;
  const Quadratic<Dyadic> f = quadratic(c, s);
  if (f.a.sign() == 0 || discriminant_of(f).sign() != 0) return found;
  Crossing k = rational_crossing(-f.b, f.a);
  if (omega.sign() == 0 && k.p.sign() <= 0) return found;
  if (c.segment || c.closed || on_part(c, s, a, c.end_point(), k)) found.push_back(std::move(k));
  return found;
}

AroundEnd ExactFlight::Data::around(int piece, bool at_end, Cell cell, const Crossing& k) const {
  const ExactCurve& c = curve(piece);
  const View s = view(piece, cell);
  if (c.bezier()) return around_end(at_curve(c, s, false, false), at_end, velocity_at(k));
  Polynomial f;
  if (needs_quartic(c)) {
    f = quartic(c, s);
  } else {
    const Quadratic<Dyadic> q = quadratic(c, s);
    f = {q.c, Dyadic(2) * q.b, q.a};
  }
  // The first derivative that does not vanish at p/r, r > 0; kappa falls in time.
  for (bool odd = true; f.size() > 1; odd = !odd) {
    for (std::size_t i = 1; i < f.size(); ++i) f[i - 1] = Dyadic(static_cast<int>(i)) * f[i];
    f.pop_back();
    Dyadic value, power(1);
    for (std::size_t i = f.size(); i-- > 0; power = power * k.r) value = value * k.p + f[i] * power;
    if (value.sign() != 0) return {value.sign(), odd ? -value.sign() : value.sign(), !odd};
  }
  return {0, 0, true};
}

bool ExactFlight::Data::hits_joint(int piece, Cell cell, const Crossing& k) const {
  const int previous = boundary.previous[static_cast<std::size_t>(piece)];
  if (previous < 0) return true;
  const ExactCurve& before = curve(previous);
  const ExactCurve& after = curve(piece);
  const DyadicVector in = before.direction_at(-1.0);
  const DyadicVector out = after.direction_at(0.0);
  const AroundEnd first = around(previous, true, cell, k), second = around(piece, false, cell, k);
  const int turn = cross(in, out).sign();
  if (turn > 0) return first.before > 0 && second.before > 0;
  if (turn < 0) return first.before > 0 || second.before > 0;
  if (dot(in, out).sign() < 0) return true;  // the tip of a cusp
  if (!second.tangent) return second.before > 0;
  // Along the common tangent: it comes beside one wall and goes on beside the other, or through the
  // joint.
  const bool forwards = dot(velocity_at(k), out).sign() > 0;
  const int comes = forwards ? first.before : second.before,
            goes = forwards ? second.after : first.after;
  return comes > 0 && goes <= 0;
}

ExactFlight::First ExactFlight::first(const std::vector<int>& pieces, Cell cell, int entry,
                                      int start, int start_previous) const {
  const Data& d = *data_;
  const bool at_joint = start_previous >= 0;
  std::optional<Crossing> entered;
  if (entry >= 0 && d.omega.sign() != 0)
    entered = quadratic_crossing(d.quadratic(d.curve(entry), d.view(entry, cell)), -1);
  First best;
  std::optional<Crossing> best_crossing;
  std::vector<int> zero_joints;
  for (const int piece : pieces) {
    const bool edge = d.boundary.pieces[static_cast<std::size_t>(piece)].edge;
    std::vector<Crossing> exits = d.exits(piece, cell, piece == start, piece == start_previous,
                                          at_joint, edge ? nullptr : &zero_joints);
    for (std::size_t i = 0; i < exits.size(); ++i) {
      if (edge && entered) {
        const int order = compare(exits[i], *entered);
        if (order > 0 || (order == 0 && piece == entry)) continue;
      }
      const int order = best_crossing ? compare(exits[i], *best_crossing) : 1;
      if (order < 0) continue;
      const First candidate{First::Kind::exit, piece, static_cast<int>(i), approximate(exits[i]),
                            exits[i].place ? approximate(*exits[i].place) : 0.0};
      if (order == 0) {
        // Walls before edges; two walls at one point that is no joint are a cusp.
        const bool best_edge = d.boundary.pieces[static_cast<std::size_t>(best.piece)].edge;
        if (edge && !best_edge) continue;
        if (!edge && !best_edge && best.kind == First::Kind::exit) best.kind = First::Kind::cusp;
        if (!best_edge) continue;
      }
      best = candidate;
      best_crossing = exits[i];
    }
  }
  // One tangency is no hit; two at one point are a cusp, through whose tip no flight leads.
  std::vector<Crossing> touched;
  for (const int piece : pieces) {
    if (d.boundary.pieces[static_cast<std::size_t>(piece)].edge) continue;
    // A circle or line that is crossed at the start is nowhere touched.
    if (piece == start && !d.needs_quartic(d.curve(piece)) && !d.curve(piece).bezier()) continue;
    for (Crossing& k :
         d.touches(piece, cell, piece == start, at_joint && piece == start_previous)) {
      if (best_crossing && compare(k, *best_crossing) < 0) continue;
      for (const Crossing& other : touched) {
        if (compare(other, k) != 0) continue;
        best = {First::Kind::cusp, piece, 0, approximate(k), 0.0};
        best_crossing = k;
      }
      touched.push_back(std::move(k));
    }
  }
  for (const int piece : zero_joints) {
    const Data::View s = d.view(piece, cell);
    const ExactCurve& c = d.curve(piece);
    const ExactPoint joint{c.from.x, c.from.y, Dyadic(1)};
    const auto [offset, factor] = Data::offset(s, joint);
    if (dot(offset, offset).sign() == 0) continue;  // the particle is on it
    const Crossing k = d.through(s, joint);
    if (d.omega.sign() == 0 && k.p.sign() <= 0) continue;
    if (!d.hits_joint(piece, cell, k)) continue;
    if (best_crossing && compare(k, *best_crossing) < 0) continue;
    best = {First::Kind::joint, piece, 0, 0.0, 0.0};
    best_crossing = k;
  }
  return best;
}

Sign ExactFlight::side(int piece, double u, Cell cell) const {
  const ExactCurve& c = data_->curve(piece);
  return static_cast<Sign>(
      data_->side(data_->view(piece, cell), u < 0 ? c.end_point() : c.point(u)));
}

bool ExactFlight::exit_within(int piece, int root, Cell cell, double from, double to,
                              bool start) const {
  const Data& d = *data_;
  const ExactCurve& c = d.curve(piece);
  const Data::View s = d.view(piece, cell);
  std::optional<Crossing> k;
  if (c.bezier()) {
    const AlgebraicRoot u = *d.exits(piece, cell, start, false, false, nullptr)
                                 .at(static_cast<std::size_t>(root))
                                 .place;
    return compare(u, Dyadic(from).rational()) >= 0 &&
           (to < 0 || compare(u, Dyadic(to).rational()) < 0);
  }
  if (d.needs_quartic(c)) {
    const std::vector<Crossing> all = d.exits(piece, cell, start, false, false, nullptr);
    k = all.at(static_cast<std::size_t>(root));
  } else {
    k = quadratic_crossing(d.quadratic(c, s));
  }
  if (!k) throw InternalError("a hole was asked for an exit that does not exist");
  const ExactPoint a = c.point(from), b = to < 0 ? c.end_point() : c.point(to);
  if (c.segment) {
    // before(x): is the crossing at or beyond x along the wall? dot(direction, x - a) >= 0.
    const auto beyond = [&](const ExactPoint& at) {
      const DyadicVector e{s.x * at.w - at.x * s.w, s.y * at.w - at.y * s.w};
      return sign_at_crossing(
                 line_quadratic(e, right(c.direction), s.w * at.w * d.v, d.omega, one_half()),
                 *k) >= 0;
    };
    return beyond(a) && !beyond(b);
  }
  // A crossing exactly at `from` is inside, at `to` outside.
  const auto at = [&](const ExactPoint& p) {
    const DyadicVector offset = Data::offset(s, p).first;
    if (dot(offset, offset).sign() == 0) return false;  // where the particle is it does not arrive
    if (d.side(s, p) != 0) return false;
    return compare(d.through(s, p), *k) == 0;
  };
  if (at(a)) return true;
  if (at(b)) return false;
  return d.on_part(c, s, a, b, *k);
}

Sign ExactFlight::left_of(int piece, Cell cell) const {
  const ExactCurve& c = data_->curve(piece);
  const Data::View s = data_->view(piece, cell);
  return sign_of(cross(c.direction, DyadicVector{s.x - s.w * c.from.x, s.y - s.w * c.from.y}));
}

}  // namespace carom::geometry
