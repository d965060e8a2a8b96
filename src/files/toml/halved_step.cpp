#include "files/toml/halved_step.hpp"

#include <fmt/format.h>

#include "files/toml/toml_section.hpp"

namespace carom::files {

void halve_step(LoadedSystem& loaded) {
  double& step = loaded.system.dynamics.integrator.step;
  step *= 0.5;
  Value root = parse_document(loaded.resolved_toml, loaded.system.name);
  Value* const written = root.find("integrator")->find("step");
  *written = number_value(fmt::format("{}", step), written->place);
  loaded.resolved_toml = print_document(root);
}

}  // namespace carom::files
