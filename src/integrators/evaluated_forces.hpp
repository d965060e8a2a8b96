// Accelerations at positions that steps begin or end with, so that no force is computed twice.
#pragma once

#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "carom/integrators/stepper.hpp"

namespace carom::integrators {

/// Remembers the accelerations at the start under way and at the ends of two steps from it: of the
/// first, which is the whole step as a rule, and of the latest, which may be a part of it. A
/// remembered value is used only for positions of the same bits, so that it changes nothing but the
/// cost.
template <class Real>
class EvaluatedForces {
 public:
  using Vector = geometry::BasicVector<Real>;

  explicit EvaluatedForces(const ForceLaw<Real>& law) : law_(law) {}

  std::span<const Vector> at_start(std::span<const Vector> position) {
    if (matches(start_, position)) return start_.acceleration;
    if (matches(whole_, position)) {
      std::swap(start_, whole_);
    } else if (matches(part_, position)) {
      std::swap(start_, part_);
    } else {
      evaluate(start_, position);
    }
    whole_.position.clear();
    part_.position.clear();
    return start_.acceleration;
  }
  std::span<const Vector> at_end(std::span<const Vector> position) {
    // A part that ends where the whole step does, to rounding, is evaluated as any other: what a
    // path costs depends on how it is cut alone.
    Known& end = whole_.position.empty() ? whole_ : part_;
    if (!matches(end, position)) evaluate(end, position);
    return end.acceleration;
  }

  void forget() {
    for (Known* known : {&start_, &whole_, &part_}) known->position.clear();
  }

  /// What is known at these positions from the start under way, or nothing.
  std::span<const Vector> remembered(std::span<const Vector> position) const {
    if (matches(start_, position)) return start_.acceleration;
    return {};
  }
  /// The same, also at the ends.
  std::span<const Vector> remembered_anywhere(std::span<const Vector> position) const {
    for (const Known* known : {&start_, &whole_, &part_})
      if (matches(*known, position)) return known->acceleration;
    return {};
  }

 private:
  struct Known {
    std::vector<Vector> position, acceleration;
  };

  static bool matches(const Known& known, std::span<const Vector> position) {
    if (known.position.size() != position.size()) return false;
    if constexpr (std::is_trivially_copyable_v<Real>) {
      return std::memcmp(known.position.data(), position.data(), position.size_bytes()) == 0;
    } else {
      for (std::size_t i = 0; i < position.size(); ++i)
        if (!(known.position[i] == position[i])) return false;
      return true;
    }
  }
  void evaluate(Known& known, std::span<const Vector> position) {
    known.position.assign(position.begin(), position.end());
    known.acceleration.resize(position.size());
    law_.accelerations(position, known.acceleration);
  }

  const ForceLaw<Real>& law_;
  Known start_, whole_, part_;
};

}  // namespace carom::integrators
