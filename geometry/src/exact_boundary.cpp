#include "exact_boundary.hpp"

namespace carom::geometry {

ExactBoundary::ExactBoundary(const std::vector<Piece>& pieces, Vector first, Vector second)
    : data_(std::make_unique<Data>(pieces)) {
  data_->first = exact(first);
  data_->second = exact(second);
  data_->previous.assign(pieces.size(), -1);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (const int next = pieces[i].next; next >= 0 && next != static_cast<int>(i))
      data_->previous[static_cast<std::size_t>(next)] = static_cast<int>(i);
}
ExactBoundary::~ExactBoundary() = default;
ExactBoundary::ExactBoundary(ExactBoundary&&) noexcept = default;

Sign ExactBoundary::inward(int piece, double u, Vector v) const {
  const ExactCurve& c = data_->curve(piece);
  return sign_of(cross(c.direction_at(u), exact(v)));
}

Sign ExactBoundary::inward_at_end(int piece, Vector v) const {
  const ExactCurve& c = data_->curve(piece);
  return sign_of(cross(c.direction_at(-1.0), exact(v)));
}

ExactBoundary::Corner ExactBoundary::corner(int previous, int next) const {
  const ExactCurve& before = data_->curve(previous);
  const ExactCurve& after = data_->curve(next);
  const DyadicVector in = before.direction_at(-1.0);
  const DyadicVector out = after.direction_at(0.0);
  const Dyadic turn = cross(in, out), along = dot(in, out);
  if (turn.sign() == 0) return {0, along.sign() > 0 ? 1 : 0};
  if (turn.sign() > 0 && along.sign() == 0) return {1, 2};
  if (turn.sign() > 0 && (turn + along).sign() == 0) return {1, 4};  // turn by 3 pi/4
  return {turn.sign(), 0};
}

bool ExactBoundary::same_ellipse(int first, int second) const {
  const ExactCurve& a = data_->curve(first);
  const ExactCurve& b = data_->curve(second);
  const auto same = [](const DyadicVector& x, const DyadicVector& y) {
    return (x.x - y.x).sign() == 0 && (x.y - y.y).sign() == 0;
  };
  return !a.metric.euclidean && !b.metric.euclidean && same(a.metric.p, b.metric.p) &&
         (a.metric.k - b.metric.k).sign() == 0 && same(a.centre, b.centre) &&
         (a.r2 - b.r2).sign() == 0;
}

}  // namespace carom::geometry
