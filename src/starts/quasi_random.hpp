// Quasi-random starts.
#pragma once

#include <vector>

#include "carom/base/error.hpp"
#include "starts/cover.hpp"
#include "starts/sobol.hpp"

namespace carom::starts {

/// Where the points of Sobol' sequences lie in a domain. docs/physics/quasi-random.md derives it.
class QuasiRandom {
 public:
  QuasiRandom(std::uint64_t seed, Cover cover);
  Sobol::Point point(std::uint64_t trajectory) const;
  const Cover& cover() const { return cover_; }

 private:
  std::vector<Sobol> sequences_;  ///< one a replicate
  Cover cover_;
};

}  // namespace carom::starts
