#include "integrators/ode_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "carom/base/elementary.hpp"

namespace carom::integrators {
namespace {

using geometry::Vector;

double largest(std::span<const Vector> list) {
  double most = 0.0;
  for (const Vector& a : list) most = std::max({most, std::fabs(a.x), std::fabs(a.y)});
  return most;
}

}  // namespace

OdeProblem::OdeProblem(const ForceLaw<double>& law, std::span<const double> omega, double tolerance)
    : law_(law),
      known_(law),
      omega_(omega.begin(), omega.end()),
      tolerance_(tolerance),
      state_(N_VNew_Serial(static_cast<sunindextype>(4 * omega.size()), context_)),
      position_(omega.size()),
      acceleration_(omega.size()) {
#if SUNDIALS_VERSION_MAJOR >= 7
  SUNContext_ClearErrHandlers(context_);
#endif
}

double OdeProblem::largest_acceleration(const Phase<double>& from) {
  const std::span<const Vector> forced = known_.at_start(from.position);
  double most = 0.0;
  for (std::size_t i = 0; i < forced.size(); ++i) {
    const Vector a = forced[i] + omega_[i] * right(from.velocity[i]);
    most = std::max({most, std::fabs(a.x), std::fabs(a.y)});
  }
  return most;
}

OdeProblem::Scale OdeProblem::first_scale(const Phase<double>& from) {
  const double a = largest_acceleration(from);
  Scale scale{largest(from.position), largest(from.velocity)};
  scale.velocity = std::max(scale.velocity, std::sqrt(a * scale.position));
  if (!(scale.position > 0.0) && a > 0.0) scale.position = scale.velocity * scale.velocity / a;
  if (!(scale.position > 0.0)) scale.position = scale.velocity > 0.0 ? scale.velocity : 1.0;
  if (!(scale.velocity > 0.0)) scale.velocity = scale.position;
  return scale;
}

bool OdeProblem::leads_on(double duration) {
  constexpr int most = 10000;
  tiny_steps_ = scale_.is_short(duration) ? tiny_steps_ + 1 : 0;
  if (tiny_steps_ <= most) return true;
  failure_ = "the adaptive scheme has reached its limit of 10000 steps in a row that lead nowhere";
  return false;
}

double OdeProblem::resolved(const Phase<double>& from, double asked) {
  const double allowed = law_.longest_step(from, asked);
  if (allowed >= asked) return asked;
  if (allowed > 0.0 && !scale_.is_short(allowed)) return allowed;
  failure_ = fmt::format("the force cannot be resolved at ({:.6g}, {:.6g})", from.position[0].x,
                         from.position[0].y);
  if (from.position.size() > 1) failure_ += ", or where another of its group is";
  return 0.0;
}

double OdeProblem::first_step(const Phase<double>& from, int order) {
  const double a = largest_acceleration(from);
  double time = longest_step();
  if (a > 0.0) time = std::min(time, scale_.velocity / a);
  return time * elementary::exp(elementary::log(tolerance_) / (order + 1));
}

void OdeProblem::load(const Phase<double>& phase) {
  double* y = N_VGetArrayPointer(state_.get());
  for (const std::vector<Vector>* list : {&phase.position, &phase.velocity}) {
    for (const Vector& a : *list) {
      *y++ = a.x;
      *y++ = a.y;
    }
  }
  known_.at_start(phase.position);
}

void OdeProblem::unload(Phase<double>& to, bool ok) const {
  const double* y = N_VGetArrayPointer(state_.get());
  for (std::vector<Vector>* list : {&to.position, &to.velocity}) {
    list->resize(omega_.size());
    for (Vector& a : *list) {
      a = ok ? Vector{y[0], y[1]} : Vector{std::nan(""), std::nan("")};
      y += 2;
    }
  }
}

void OdeProblem::rethrow() {
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void OdeProblem::compute(const double* y, double* dy) {
  const std::size_t n = omega_.size();
  for (std::size_t i = 0; i < n; ++i) position_[i] = {y[2 * i], y[2 * i + 1]};
  const std::span<const Vector> remembered = known_.remembered(position_);
  if (remembered.empty()) law_.accelerations(position_, acceleration_);
  const Vector* a = remembered.empty() ? acceleration_.data() : remembered.data();
  const double* v = y + 2 * n;
  for (std::size_t i = 0; i < n; ++i) {
    dy[2 * i] = v[2 * i];
    dy[2 * i + 1] = v[2 * i + 1];
    dy[2 * (n + i)] = a[i].x + omega_[i] * v[2 * i + 1];
    dy[2 * (n + i) + 1] = a[i].y - omega_[i] * v[2 * i];
  }
}

int OdeProblem::derivative(double, N_Vector y, N_Vector dy, void* self) {
  auto& problem = *static_cast<OdeProblem*>(self);
  double* out = N_VGetArrayPointer(dy);
  try {
    problem.compute(N_VGetArrayPointer(y), out);
  } catch (...) {
    problem.thrown_ = std::current_exception();
    return -1;
  }
  // A force that is not a number may be one after a smaller step.
  return std::all_of(out, out + 4 * problem.omega_.size(),
                     [](double a) { return std::isfinite(a); })
             ? 0
             : 1;
}

int OdeProblem::weights(N_Vector y, N_Vector weight, void* self) {
  auto& problem = *static_cast<OdeProblem*>(self);
  const std::size_t n = 2 * problem.omega_.size();
  const double* now = N_VGetArrayPointer(y);
  double* w = N_VGetArrayPointer(weight);
  for (std::size_t i = 0; i < n; ++i) {
    problem.scale_.position = std::max(problem.scale_.position, std::fabs(now[i]));
    problem.scale_.velocity = std::max(problem.scale_.velocity, std::fabs(now[n + i]));
  }
  std::fill(w, w + n, 1.0 / (problem.tolerance_ * problem.scale_.position));
  std::fill(w + n, w + 2 * n, 1.0 / (problem.tolerance_ * problem.scale_.velocity));
  return 0;
}

bool same_bits(const Phase<double>& a, const Phase<double>& b) {
  const std::size_t bytes = a.position.size() * sizeof(Vector);
  return a.position.size() == b.position.size() && bytes > 0 &&
         std::memcmp(a.position.data(), b.position.data(), bytes) == 0 &&
         std::memcmp(a.velocity.data(), b.velocity.data(), bytes) == 0;
}

}  // namespace carom::integrators
