// The inside of ExactBoundary.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "carom/geometry/exact_flight.hpp"
#include "exact_curve.hpp"

namespace carom::geometry {

struct ExactBoundary::Data {
  std::vector<Piece> pieces;
  std::vector<int> previous;  // the piece that ends where each begins, or -1
  // Made when first asked for, by any thread.
  mutable std::vector<std::atomic<const ExactCurve*>> curves;
  DyadicVector first, second;

  explicit Data(const std::vector<Piece>& of) : pieces(of), curves(of.size()) {}
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  ~Data() {
    for (const auto& made : curves) delete made.load();
  }

  const ExactCurve& curve(int piece) const {
    auto& made = curves[static_cast<std::size_t>(piece)];
    if (const ExactCurve* found = made.load(std::memory_order_acquire)) return *found;
    auto mine = std::make_unique<const ExactCurve>(pieces[static_cast<std::size_t>(piece)].curve);
    const ExactCurve* other = nullptr;  // another thread may have been faster
    if (made.compare_exchange_strong(other, mine.get())) return *mine.release();
    return *other;
  }

  DyadicVector translation(Cell c) const {
    const Dyadic m(static_cast<double>(c.first)), n(static_cast<double>(c.second));
    return {m * first.x + n * second.x, m * first.y + n * second.y};
  }
};

}  // namespace carom::geometry
