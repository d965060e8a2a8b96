// What depends on a step's length and a particle's omega alone, made once for each pair.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace carom::integrators {

/// Particles of equal omega share one entry; the entries of two lengths of steps are kept, so that
/// parts of steps do not drive out those of the whole step, which comes back.
template <class Real, class Entry>
class PerParticle {
 public:
  explicit PerParticle(std::span<const Real> omega) {
    for (const Real& w : omega) {
      std::size_t k = 0;
      while (k < distinct_.size() && !(distinct_[k] == w)) ++k;
      if (k == distinct_.size()) distinct_.push_back(w);
      entry_of_.push_back(k);
    }
  }
  std::size_t entry_of(std::size_t particle) const { return entry_of_[particle]; }
  std::size_t size() const { return distinct_.size(); }
  std::size_t particles() const { return entry_of_.size(); }

  /// The entries for a step: make(omega, into) appends those of one omega.
  const std::vector<Entry>& of_step(const Real& step, const auto& make) {
    if (!usual_.entries.empty() && usual_.step == step) return usual_.entries;
    if (!latest_.entries.empty() && latest_.step == step) {
      std::swap(usual_, latest_);
      return usual_.entries;
    }
    latest_.step = step;
    latest_.entries.clear();
    for (const Real& omega : distinct_) make(omega, latest_.entries);
    return latest_.entries;
  }

 private:
  struct Made {
    Real step{};
    std::vector<Entry> entries;
  };
  std::vector<Real> distinct_;
  std::vector<std::size_t> entry_of_;
  Made usual_, latest_;
};

}  // namespace carom::integrators
