// What describe() is, and what all ensembles have in common.
//
// describe(visitor, result, system) says once what a result holds: groups of archives, their
// numbers and columns, with units and meaning. A visitor writes an archive, reads one, makes JSON
// or the tables of the guide (files/describe/). It has
//
//   group(path, text), group_if(there, path, text)  what follows is in it; the latter: is it there?
//   number(label, value), number_if(there, …)       in archives and JSON
//   numbers_if(there, s)                            the fields of a struct
//   kept(label, value)                              in archives alone, as all columns below
//   kept_column(label, values, count)               this many numbers
//   kept_each(label, count, get)                    get(i) is a reference to the i-th
//   sums(label, count, get)                         the same for exact sums
//   rows(make), kept_rows(make)                     computed: the fields of what make() gives
//   computed(label, make)                           a computed number or column, in archives
//   alone
//
// and what a few results need besides (fates, bins, columns with names, what is expected).
// `there` is what the system says; readers ask the archive instead, and never call `make`. So the
// system may be an empty one where an archive is read.
#pragma once

#include <concepts>
#include <functional>
#include <type_traits>

#include "carom/results/ensemble_result.hpp"
#include "carom/results/fate_counts.hpp"
#include "carom/system/system.hpp"

namespace carom::results {

/// A result that is read, or one that is written.
template <class R, class Result>
concept OrConst = std::same_as<std::remove_const_t<R>, Result>;

/// The numbers of a struct, or of a base of it, as the fields say.
template <class Struct>
void describe_numbers(auto& v, auto& s, const System& system) {
  each_field<Fields<Struct>>([&](const auto& one) {
    auto& value = std::invoke(one.at, s);
    if (one.archived)
      v.kept(one.label, value);
    else if (one.there != nullptr)
      v.number_if((system.*one.there)(), one.label, value);
    else
      v.number(one.label, value);
  });
}

/// What integration has cost, and how well energies were kept.
void describe_integration(auto& v, auto& result, const System& system) {
  v.numbers_if(system.is_integrated(), result.energy_error);
  v.numbers_if(system.is_integrated(), result.steps);
}

/// /fates of ensembles whose particles are counted one by one.
void describe_ends(auto& v, auto& result, const System& system) {
  v.number({"trajectories", "1", "All particles of all trajectories"}, result.trajectories);
  v.fates(result, result.trajectories);
  describe_numbers<EndCounts>(v, result, system);
  v.number({"digest", "1",
            "Sum of a hash of each trajectory's end: different ends give a different digest"},
           result.digest);
  describe_integration(v, result, system);
}

}  // namespace carom::results
