
#include <vector>

#include "carom/integrators/scheme.hpp"
#include "integrators/embedded_table.hpp"
#include "integrators/stages.hpp"

namespace carom {

namespace {

using integrators::Stage;
using integrators::stages_of;

/// A kick at the end of a step and that at the start of the next one are at the same positions.
int evaluations_a_step(const Scheme& scheme) {
  if (scheme.form == Scheme::Form::spreiter_walter) return 1;
  using Kind = Stage<double>::Kind;
  const std::vector<Stage<double>> stages = stages_of<double>(scheme);
  int evaluations = 0;
  bool moved = false;
  for (const Stage<double>& stage : stages) {
    if (stage.kind == Kind::drift || stage.kind == Kind::straight) moved = true;
    if (stage.kind == Kind::kick && moved) {
      ++evaluations;
      moved = false;
    }
  }
  // What moves last makes the force of a kick at the start of the next step a new one.
  return evaluations + (moved && stages.front().kind == Kind::kick ? 1 : 0);
}

std::string_view kind_of(const Scheme& scheme) {
  switch (scheme.form) {
    case Scheme::Form::spreiter_walter:
      return "frozen force in a field";
    case Scheme::Form::he:
      return "keeps volumes, field split off";
    case Scheme::Form::verlets:
      return "symplectic, of Verlet steps";
    default:
      break;
  }
  if (scheme.quadratic)
    return scheme.symmetric() ? "symplectic, Nyström" : "symplectic, Nyström, not symmetric";
  return scheme.symmetric() ? "symplectic" : "symplectic, not symmetric";
}

std::vector<SchemeDescription> make_list() {
  std::vector<SchemeDescription> list;
  for (const Scheme& scheme : schemes())
    list.push_back({.name = scheme.name,
                    .order = scheme.order,
                    .stages = evaluations_a_step(scheme),
                    .symmetric = scheme.symmetric(),
                    .symplectic = scheme.symplectic(),
                    .quadratic = scheme.quadratic,
                    .kind = kind_of(scheme),
                    .source = scheme.source});
  const integrators::EmbeddedTable& table = integrators::verner_9_8();
  list.push_back({.name = "arkode",
                  .order = table.order,
                  .stages = static_cast<int>(table.time.size()),
                  .adaptive = true,
                  .kind = "adaptive, Runge–Kutta",
                  .source = "Verner's most efficient pair 9(8); ARKODE of SUNDIALS"});
  list.push_back({.name = "cvode",
                  .adaptive = true,
                  .kind = "adaptive, Adams, orders 1 to 12",
                  .source = "CVODE of SUNDIALS"});
  return list;
}

}  // namespace

const std::vector<SchemeDescription>& scheme_descriptions() {
  static const std::vector<SchemeDescription> list = make_list();
  return list;
}

}  // namespace carom
