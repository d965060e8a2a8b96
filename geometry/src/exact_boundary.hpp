// The inside of ExactBoundary.
#pragma once

#include <memory>
#include <vector>

#include "carom/geometry/exact_flight.hpp"
#include "exact_curve.hpp"

namespace carom::geometry {

struct ExactBoundary::Data {
  std::vector<Piece> pieces;
  std::vector<int> previous;  // the piece that ends where each begins, or -1
  mutable std::vector<std::unique_ptr<const ExactCurve>> curves;  // made when first asked for
  DyadicVector first, second;

  const ExactCurve& curve(int piece) const {
    auto& made = curves[static_cast<std::size_t>(piece)];
    if (!made)
      made = std::make_unique<const ExactCurve>(pieces[static_cast<std::size_t>(piece)].curve);
    return *made;
  }

  DyadicVector translation(Cell c) const {
    const Dyadic m(static_cast<double>(c.first)), n(static_cast<double>(c.second));
    return {m * first.x + n * second.x, m * first.y + n * second.y};
  }
};

}  // namespace carom::geometry
