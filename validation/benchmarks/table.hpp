// The one table of ./dev bench: what each thing costs, beside a second path in the same run and a
// physical check.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace carom::bench {

struct Line {
  std::string what;     ///< a system, and what is counted
  std::string path;     ///< the code that was measured
  double each = 0.0;    ///< nanoseconds of CPU time
  double links = 0.0;   ///< the same in links of a chain of roots and divisions
  std::string against;  ///< the second path; "": none
  double ratio = 0.0;   ///< of its time to this one
  std::string check;    ///< what was found, and what it must be
  bool right = true;
};

/// Prints lines as they come.
class Report {
 public:
  enum class Aim { measure, list };
  /// `wanted`: beginnings of names; none: all. To list is to want nothing and to print the name of
  /// each row once.
  explicit Report(Aim aim, std::vector<std::string> wanted = {});
  bool wants(std::string_view what);
  void add(const Line& line);
  /// Was a row wrong, or a wanted name no row's?
  bool failed() const;

 private:
  struct Name {
    std::string begin;
    bool found = false;
  };
  Aim aim_;
  std::vector<Name> wanted_;
  std::set<std::string, std::less<>> listed_;
  bool wrong_ = false;
};

/// The rows, by room.
void straight_and_larmor_flights(
    Report&);                           ///< scalar engine, stepping in time, a loop over obstacles
void flights_in_lanes(Report&);         ///< lanes of every instruction set of this machine
void steps_under_forces(Report&);       ///< the same for steps
void questions_of_resolution(Report&);  ///< does a step resolve its forces?
void groups_at_walls(Report&);          ///< charges that hit walls, beside their forces alone
void contacts_of_hard_discs(Report&);
void certified_orbits(Report&);  ///< beside plain MPFR
void periodic_orbits(Report&);
void comparisons(Report&);      ///< of integrators, beside their runs alone
void whole_ensembles(Report&);  ///< starts, sums and threads included
void records_of_runs(Report&);  ///< each hit of an orbit stored

}  // namespace carom::bench
