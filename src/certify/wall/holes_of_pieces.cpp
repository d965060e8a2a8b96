#include "certify/wall/holes_of_pieces.hpp"

#include <algorithm>
#include <cmath>

#include "certify/number/exact_value.hpp"
#include "table/shapes.hpp"

namespace carom::certify {
namespace {

/// Of lengths. Hits that it does not tell from the end of a hole are as good as ties.
constexpr slong most_bits = 512;
/// A little more than the part: neighbours overlap.
constexpr double beyond = 0x1.0001p0;

Series speed_about(const Piece& piece, const Ball& t, slong terms) {
  const Series::Terms more(terms + 1);
  VectorOf<Series> x = piece.about(t);
  for (Series* one : {&x.x, &x.y}) arb_poly_derivative(one->raw(), one->raw(), Precision::bits());
  const Series::Terms those(terms);
  Series speed = x.x * x.x + x.y * x.y;
  const Ball least = sqrt(speed[0]);
  arb_poly_sqrt_series(speed.raw(), speed.raw(), terms, Precision::bits());
  speed.set(0, least);
  return speed;
}

Ball value_at(const Series& polynomial, const Ball& x) {
  return made<Ball>(arb_poly_evaluate, polynomial.raw(), x.raw(), Precision::bits());
}

}  // namespace

ArcLength::ArcLength(const Piece& piece) : piece_(piece) { add(0.0, 1.0, 48); }

void ArcLength::add(double from, double to, int depth) {
  const auto at = [&](double share) { return piece_.from + Ball(share) * piece_.length; };
  const Ball middle = at(0.5 * (from + to)), first = at(from) - middle, last = at(to) - middle;
  const Ball range = middle.widened(size_of(last) * Bound(beyond));
  // Taylor's series about the middle; the coefficient of its last term is that of somewhere.
  const auto terms = depth == 0 ? 0 : static_cast<slong>(8 + Precision::bits() / 4);
  const Series::Terms all(terms + 2);
  const Series speed = speed_about(piece_, range, terms + 1);
  const double half = 0.5 * (to - from), bits = static_cast<double>(Precision::bits());
  if (depth > 0 &&
      !(size_of(speed[terms]).log2() + static_cast<double>(terms) * size_of(last).log2() <
        size_of(speed[0]).log2() - bits)) {
    add(from, from + half, depth - 1);
    add(from + half, to, depth - 1);
    return;
  }
  Series length = speed_about(piece_, middle, terms + 1);
  length.set(terms, speed[terms]);
  arb_poly_integral(length.raw(), length.raw(), Precision::bits());
  const Ball before = sum_ - value_at(length, first);
  sum_ = before + value_at(length, last);
  parts_.push_back({range, middle, std::move(length), before});
}

Ball ArcLength::to(const Ball& t) const {
  for (const Part& part : parts_)
    if (part.range.contains(t)) return part.before + value_at(part.length, t - part.middle);
  return Ball(0).widened(Bound(HUGE_VAL));
}

HolesOfPieces::HolesOfPieces(const ExactSystem& system, const Pieces& pieces) : pieces_(pieces) {
  const Precision precision(std::min(Precision::bits(), most_bits));
  const Table& table = *system.table;
  for (std::size_t k = 0; k < system.spec->holes.size(); ++k) {
    const HoleSpec& spec = system.spec->holes[k];
    const Ball centre = value_of(spec.center), half = value_of(spec.width) / 2;
    const std::vector<int> walls = table::shapes::stretch_named(spec.wall, spec.wall_place, table);
    Opening opening{table.hole_index(name_of_hole(system.spec->holes, k)),
                    centre - half,
                    centre + half,
                    Ball(0),
                    geometry::start_point(table.wall(walls.front()).curve) ==
                        geometry::end_point(table.wall(walls.back()).curve),
                    {}};
    for (const int wall : walls) {
      const auto [piece, first, last, of] = pieces.ends(wall);
      const ArcLength& length = lengths_.try_emplace(piece, pieces[piece]).first->second;
      const Ball start = length.to(first), part = length.to(last) - start;
      const bool forwards = pieces[piece].turn > 0.0;
      auto [stretch, is_new] = opening.stretches.try_emplace(
          piece, Stretch{start, opening.length, Ball(0), of == 1 || walls.size() > 1});
      stretch->second.length = stretch->second.length + (forwards ? part : -part);
      opening.length = opening.length + (forwards ? part : -part);
    }
    openings_.push_back(std::move(opening));
  }
}

Passage HolesOfPieces::passage(const Pieces::Spot& spot) const {
  const Precision precision(std::min(Precision::bits(), most_bits));
  Passage unknown;
  for (const Opening& opening : openings_) {
    const auto found = opening.stretches.find(spot.piece);
    if (found == opening.stretches.end()) continue;
    const Piece& piece = pieces_[spot.piece];
    const Stretch& stretch = found->second;
    const Ball end = piece.from + piece.length;
    Ball t = spot.t;
    if (piece.periodic)
      t = t -
          Ball(std::floor((t - piece.from).to_double() / piece.length.to_double())) * piece.length;
    if (sign(end - t) == Sign::negative) t = t - piece.length;
    if (sign(t - piece.from) == Sign::negative) t = t + piece.length;
    // Beside the joint of both ends, walls that begin or end there cannot be decided.
    if (!stretch.whole &&
        !(sign(t - piece.from) == Sign::positive && sign(end - t) == Sign::positive)) {
      unknown = {Verdict::undecided, opening.hole};
      continue;
    }
    const Ball along = lengths_.at(spot.piece).to(t);
    const Ball there = piece.turn > 0.0 ? along - stretch.start : stretch.start - along;
    const Verdict on_these =
        stretch.whole ? Verdict::yes
                      : both(at_least_zero(sign(there)), above_zero(sign(stretch.length - there)));
    for (const int more : {0, -1, 1}) {
      if (more != 0 && !opening.closed) continue;
      const Ball s = stretch.before + there + Ball(more) * opening.length;
      const Verdict within = both(
          on_these, both(at_least_zero(sign(s - opening.from)), above_zero(sign(opening.to - s))));
      if (within == Verdict::yes) return {within, opening.hole};
      if (within == Verdict::undecided) unknown = {within, opening.hole};
    }
  }
  return unknown;
}

}  // namespace carom::certify
