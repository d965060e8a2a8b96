// The motion of a group as a system of ordinary differential equations for SUNDIALS: the vector is
// all positions, then all velocities.
#pragma once

#include <nvector/nvector_serial.h>

#include <exception>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <sundials/sundials_context.hpp>
#include <type_traits>
#include <vector>

#include "carom/integrators/stepper.hpp"
#include "integrators/evaluated_forces.hpp"

namespace carom::integrators {

class OdeProblem {
 public:
  using Vector = geometry::Vector;

  OdeProblem(const ForceLaw<double>& law, std::span<const double> omega, double tolerance);
  OdeProblem(const OdeProblem&) = delete;
  OdeProblem& operator=(const OdeProblem&) = delete;

  SUNContext context() const { return context_; }
  N_Vector state() const { return state_.get(); }

  /// Sizes of positions and velocities that a relative tolerance refers to.
  struct Scale {
    double position = 0.0, velocity = 0.0;

    /// The time in which the motion goes through its own size.
    double time() const { return position / velocity; }
    /// 10000 steps of this length are a millionth of the way through the motion's own size.
    bool is_short(double duration) const { return duration < 1e-10 * time(); }
    /// A step that leads a few units in the last place on cannot be cut.
    bool is_least(double duration) const { return duration < 0x1p-48 * time(); }
  };
  /// The sizes at the beginning of a chain of steps; along it weights() lets them grow with the
  /// motion, and they never shrink, so that a particle that passes the origin or turns round asks
  /// for no more than others.
  Scale first_scale(const Phase<double>& from);
  void set_scale(const Scale& scale) { scale_ = scale; }
  const Scale& scale() const { return scale_; }
  /// No step is longer: where no force acts the error control would let steps grow without bound,
  /// and over the next force.
  double longest_step() const { return scale_.time(); }
  /// How long a step of at most `asked` may be by the law; 0, and a failure, if it is too short to
  /// lead anywhere.
  double resolved(const Phase<double>& from, double asked);
  /// Counts a step of that duration, shorter than asked for. False if it is the last of too many in
  /// a row that lead nowhere: the error control shrinks its steps towards a singular point and
  /// never gets there.
  bool leads_on(double duration);
  /// Why the last step failed; "" if it did not.
  std::string_view failure() const { return failure_; }
  void set_failure(std::string_view why) { failure_ = why; }
  static constexpr std::string_view no_step =
      "the adaptive scheme finds no step that keeps to its tolerance";
  /// A guess of a step that an error estimate of order p accepts.
  double first_step(const Phase<double>& from, int order);

  void load(const Phase<double>& phase);
  /// Takes over the state of SUNDIALS. `ok` false: the motion could not be computed, and all is
  /// NaN.
  void unload(Phase<double>& to, bool ok) const;
  /// Throws what a force law has thrown inside a callback.
  void rethrow();

  // What SUNDIALS calls; the last argument is this object.
  static int derivative(double time, N_Vector y, N_Vector dy, void* self);
  static int weights(N_Vector y, N_Vector weight, void* self);
#if SUNDIALS_VERSION_MAJOR < 7  // later it is the context that speaks
  static void no_message(int, const char*, const char*, char*, void*) {}
#endif

 private:
  struct FreeVector {
    void operator()(N_Vector v) const { N_VDestroy(v); }
  };
  void compute(const double* y, double* dy);
  double largest_acceleration(const Phase<double>& from);

  sundials::Context context_;
  const ForceLaw<double>& law_;
  EvaluatedForces<double> known_;  // at the starts of steps: SUNDIALS asks for these more than once
  std::vector<double> omega_;
  double tolerance_;
  int tiny_steps_ = 0;  ///< in a row
  std::string failure_;
  Scale scale_;
  std::unique_ptr<std::remove_pointer_t<N_Vector>, FreeVector> state_;
  std::vector<Vector> position_, acceleration_;
  std::exception_ptr thrown_;
};

/// Are the phases the same, bit for bit?
bool same_bits(const Phase<double>& a, const Phase<double>& b);

}  // namespace carom::integrators
