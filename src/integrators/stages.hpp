// A scheme's motions one after the other, in any arithmetic.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "carom/integrators/arithmetic.hpp"
#include "carom/integrators/scheme.hpp"

namespace carom::integrators {

template <class Real>
struct Stage {
  enum class Kind { drift, kick, straight, turn } kind;
  Real coefficient;  ///< in units of the step
};

namespace stages {

template <class Real>
std::vector<Real> parsed(const std::vector<std::string_view>& decimals) {
  std::vector<Real> numbers;
  for (const std::string_view decimal : decimals)
    numbers.push_back(Arithmetic<Real>::parse(decimal));
  return numbers;
}

/// The first half, what is left of the sum 1 (once, or in two equal parts), and the half backwards.
template <class Real>
std::vector<Real> mirrored(std::vector<Real> half, bool single_middle) {
  Real rest(1);
  for (const Real& a : half) rest = rest - (a + a);
  const std::size_t n = half.size();
  if (single_middle) {
    half.push_back(rest);
  } else {
    rest = rest / Real(2);
    half.push_back(rest);
    half.push_back(rest);
  }
  for (std::size_t i = n; i-- > 0;) half.push_back(half[i]);
  return half;
}

/// Two motions of one kind after each other are one.
template <class Real>
void append(std::vector<Stage<Real>>& list, typename Stage<Real>::Kind kind,
            const Real& coefficient) {
  if (!list.empty() && list.back().kind == kind) {
    list.back().coefficient = list.back().coefficient + coefficient;
  } else {
    list.push_back({kind, coefficient});
  }
}

}  // namespace stages

/// All motions of one step, in order. Empty for schemes that are no splitting.
template <class Real>
std::vector<Stage<Real>> stages_of(const Scheme& scheme) {
  using Kind = typename Stage<Real>::Kind;
  using Form = Scheme::Form;
  std::vector<Stage<Real>> list;
  if (scheme.form == Form::verlets || scheme.form == Form::he) {
    for (const Real& w : stages::mirrored(stages::parsed<Real>(scheme.weight), true)) {
      const Real half = w / Real(2);
      if (scheme.form == Form::he) stages::append(list, Kind::straight, half);
      stages::append(list, Kind::kick, half);
      stages::append(list, scheme.form == Form::he ? Kind::turn : Kind::drift, w);
      stages::append(list, Kind::kick, half);
      if (scheme.form == Form::he) stages::append(list, Kind::straight, half);
    }
    return list;
  }
  std::vector<Real> drift = stages::parsed<Real>(scheme.drift),
                    kick = stages::parsed<Real>(scheme.kick);
  if (scheme.form == Form::symmetric) {
    drift = stages::mirrored(drift, scheme.middle == Scheme::Motion::drift);
    kick = stages::mirrored(kick, scheme.middle == Scheme::Motion::kick);
  }
  for (std::size_t i = 0; i < drift.size() || i < kick.size(); ++i) {
    if (scheme.first == Scheme::Motion::drift && i < drift.size())
      list.push_back({Kind::drift, drift[i]});
    if (i < kick.size()) list.push_back({Kind::kick, kick[i]});
    if (scheme.first == Scheme::Motion::kick && i < drift.size())
      list.push_back({Kind::drift, drift[i]});
  }
  return list;
}

}  // namespace carom::integrators
