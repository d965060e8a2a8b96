// The table of fixed-step schemes: name, order, coefficients and source of each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "carom/base/error.hpp"

namespace carom {

/// A scheme splits a step of time h into motions that are solved exactly:
///   drift     the free motion, for the time a h: straight, or on the Larmor circle;
///   kick      the force, for the time b h: v += b h a(x);
///   straight  x += a h v, and turn: v turned by the magnetic field for a h (schemes that split the
///   two).
/// Coefficients are decimals with all digits that are known.
struct Scheme {
  enum class Form {
    listed,     ///< drifts and kicks by turns, all of them
    symmetric,  ///< the same, read forwards and backwards: the first halves; what the sums (1 each)
                ///< leave is in the middle
    verlets,    ///< steps kick 1/2, drift 1, kick 1/2 of lengths w h: the first half of the w
    he,  ///< steps straight 1/2, kick 1/2, turn 1, kick 1/2, straight 1/2 of lengths w h: the first
         ///< half of the w
    spreiter_walter,  ///< no splitting: motion under a frozen force, see
                      ///< docs/physics/integrators.md
  };
  enum class Motion { drift, kick };

  std::string_view name;
  int order;
  Form form;
  Motion first;                         ///< listed, symmetric: what the step begins with
  Motion middle;                        ///< symmetric: what is alone in the middle
  std::vector<std::string_view> drift;  ///< listed, symmetric
  std::vector<std::string_view> kick;
  std::vector<std::string_view> weight;  ///< verlets, he
  /// The order relies on a kinetic energy that is quadratic in the velocity (Runge–Kutta–Nyström).
  /// That holds with a magnetic field in the drift, too.
  bool quadratic;
  std::string_view source;

  bool symmetric() const { return form != Form::listed && form != Form::spreiter_walter; }
  /// Does a step keep phase-space areas? (He et al. keep the volume only.)
  bool symplectic() const { return form != Form::he && form != Form::spreiter_walter; }
};

/// All fixed-step schemes, by order.
const std::vector<Scheme>& schemes();
/// The scheme of that name, or an InputError that lists the known ones; "" is the default.
const Scheme& find_scheme(const std::string& name, const Place& place);
const Scheme& find_scheme(const std::string& name);
/// Used where a system names none: the most accurate for its cost by measurement.
const Scheme& default_scheme();
/// Adaptive schemes: "arkode" and "cvode".
bool is_adaptive(std::string_view name);

/// One integrator. A step of order p errs by O(h^(p+1)).
struct SchemeDescription {
  std::string_view name;
  int order = 0;   ///< 0: varies
  int stages = 0;  ///< evaluations of all forces a step, after the first one; 0: varies
  bool adaptive = false, symmetric = false, symplectic = false;
  bool quadratic = false;  ///< Runge–Kutta–Nyström: Scheme::quadratic
  std::string_view kind;   ///< in a few words
  std::string_view source;
};

/// All schemes with fixed steps, by order, then the adaptive ones.
const std::vector<SchemeDescription>& scheme_descriptions();

}  // namespace carom
