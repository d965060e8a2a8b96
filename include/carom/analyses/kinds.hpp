// The kinds of ensembles that can be continued, parted and merged: the only list of them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/analyses/lyapunov.hpp"
#include "carom/analyses/returns.hpp"

namespace carom {

/// Calls make(Result) for each of them, as for an explicit instantiation.
#define CAROM_FOR_ENSEMBLES(make) \
  make(EscapeResult) make(DiffusionResult) make(LyapunovResult) make(ReturnsResult)

/// Their names, in archives and on the command line.
inline const char* kind_of(const EscapeResult&) { return "escape"; }
inline const char* kind_of(const DiffusionResult&) { return "diffusion"; }
inline const char* kind_of(const LyapunovResult&) { return "lyapunov"; }
inline const char* kind_of(const ReturnsResult&) { return "returns"; }

/// Flies an ensemble of its kind (src/analyses/escape/escape.cpp and its likes).
inline EscapeResult flown(const System& system, const EnsembleOptions<EscapeResult>& how) {
  return run_escape(system, how);
}
inline DiffusionResult flown(const System& system, const EnsembleOptions<DiffusionResult>& how) {
  return run_diffusion(system, how);
}
inline LyapunovResult flown(const System& system, const EnsembleOptions<LyapunovResult>& how) {
  return run_lyapunov(system, how);
}
inline ReturnsResult flown(const System& system, const EnsembleOptions<ReturnsResult>& how) {
  return run_returns(system, how);
}

/// What a whole ensemble says beyond the sum of its parts: of exponents alone, if nothing stays.
inline void complete_sum(const System&, const EnsembleResult&, const SplittingOptions& = {}) {}
inline void complete_sum(const System& system, LyapunovResult& result,
                         const SplittingOptions& how = {}) {
  add_repeller(system, result, how);
}
/// Why nothing could be measured: of exponents alone (lyapunov.hpp).
inline std::optional<InputError> why_nothing(const System&, const EnsembleResult&) { return {}; }

/// Calls `visit` with std::type_identity of the result of that kind. False: there is no such kind.
bool for_kind(std::string_view kind, auto visit) {
#define CAROM_IF_KIND(Result)            \
  if (kind == kind_of(Result())) {       \
    visit(std::type_identity<Result>()); \
    return true;                         \
  }
  CAROM_FOR_ENSEMBLES(CAROM_IF_KIND)
#undef CAROM_IF_KIND
  return false;
}
inline bool is_ensemble(std::string_view kind) {
  return for_kind(kind, [](auto) {});
}
/// Their names, in the order of the list.
inline std::vector<std::string> kinds_of_ensembles() {
  std::vector<std::string> kinds;
#define CAROM_NAME(Result) kinds.emplace_back(kind_of(Result()));
  CAROM_FOR_ENSEMBLES(CAROM_NAME)
#undef CAROM_NAME
  return kinds;
}

}  // namespace carom
