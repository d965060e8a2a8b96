// What Carom answers to a file: the process, its JSON and what that means.
#pragma once

#include <map>
#include <string>

#include "reference.hpp"

namespace resolution {

struct Answer {
  int exit_status = 0;
  int signal = 0;         ///< that ended the program, or 0
  bool too_slow = false;  ///< stopped by this program
  double seconds = 0.0;
  std::string error;  ///< first line of standard error
  std::map<std::string, std::string>
      keys;  ///< of the JSON: "energy_error.end" is a key in an object
};

/// Runs `program run file --json`.
Answer ask(const std::string& program, const std::string& file, double most_seconds);

enum class Verdict {
  agrees,      ///< within the error that the program states
  loosely,     ///< within it, but it is larger than `loose_error`
  unresolved,  ///< the program says that its steps did not resolve the forces
  energy,      ///< the program says that the energy changed too much
  lost,        ///< another end that the program says
  refused,     ///< before it ran
  slow,        ///< neither an answer nor a refusal in time
  crashed,
  beyond,  ///< wrong in silence, by less than `loose_error`
  wrong    ///< wrong in silence, by more: as a rule another orbit
};
constexpr int verdicts = 10;
extern const char* const verdict_names[verdicts];

struct Judgement {
  Verdict verdict = Verdict::wrong;
  double position = 0.0, velocity = 0.0;                ///< the errors
  double stated_position = 0.0, stated_velocity = 0.0;  ///< by the program
};
Judgement judge(const Answer& answer, const Reference& reference);

}  // namespace resolution
