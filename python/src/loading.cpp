// Systems: text, built-in names, what a command changes in them.
#include <pybind11/stl.h>

#include <optional>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "cli/commands/compare.hpp"
#include "cli/commands/escape_options.hpp"
#include "cli/commands/run_certified.hpp"
#include "cli/commands/section.hpp"
#include "cli/common.hpp"
#include "cli/reports/table_report.hpp"
#include "cli/reports/table_svg.hpp"
#include "loaded.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

using Texts = std::vector<std::pair<std::string, std::string>>;

void set_option(cli::Options& options, const std::string& name, const std::string& text) {
  const std::pair<const char*, std::string*> all[] = {
      {"seed", &options.overrides.seed},
      {"trajectories", &options.overrides.trajectories},
      {"t_max", &options.overrides.t_max},
      {"collisions", &options.overrides.collisions},
      {"times", &options.overrides.times},
      {"position", &options.overrides.position},
      {"velocity", &options.overrides.velocity},
      {"trust_tolerance", &options.overrides.trust_tolerance},
      {"window", &options.window},
      {"on", &options.on},
      {"direction", &options.direction},
      {"points", &options.points},
      {"orbits", &options.orbits},
      {"threads", &options.threads},
      {"trajectory", &options.trajectory},
      {"engine", &options.engine},
      {"isa", &options.isa},
      {"precision", &options.precision},
      {"digits", &options.digits},
      {"block", &options.block},
      {"certify_sample", &options.certify_sample},
      {"splitting", &options.splitting},
      {"population", &options.population},
      {"repetitions", &options.repetitions},
      {"kick", &options.kick},
      {"lookback", &options.lookback},
      {"schemes", &options.schemes},
      {"steps", &options.steps},
      {"tolerances", &options.tolerances},
      {"error", &options.error},
      {"hits", &options.hits},
      {"starts", &options.starts},
      {"tries", &options.tries},
      {"scale", &options.scale}};
  for (const auto& [key, field] : all)
    if (name == key) {
      *field = text;
      return;
    }
  throw std::invalid_argument("no such option: " + name);
}

LoadedPointer load(const std::string& toml, const std::string& name, const std::string& command,
                   const Texts& set, const Texts& texts) {
  auto made = std::make_shared<Loaded>();
  cli::Options& options = made->options;
  options.command = command;
  options.line = "carom." + command + " (Python)";
  options.system = name;
  options.quiet = true;
  options.overrides.set = set;
  for (const auto& [key, text] : texts) set_option(options, key, text);
  const auto with = [&](const SystemOverrides& overrides) {
    return toml.empty() ? load_system(name, overrides) : read_system(toml, name, overrides);
  };
  if (command == "compare") {
    options.comparison_time = std::exchange(options.overrides.t_max, "");
    made->loaded = cli::load_compared(options, with);
    return made;
  }
  if (command == "section") {
    made->loaded = cli::load_section(options, with);
  } else if (command == "run") {
    made->loaded = with(cli::run_overrides(options));
  } else {
    if (command == "escape") cli::check_escape_options(options);
    SystemOverrides overrides = options.overrides;
    overrides.window = options.window;
    made->loaded =
        command == "lyapunov" ? cli::load_without_repeats(overrides, with) : with(overrides);
  }
  cli::choose_engine(options.engine, made->loaded.system);
  return made;
}

struct TableOutcome {
  LoadedPointer system;
  TableMeasure measured;
  Stopwatch watch;
};

TableOutcome measured(const std::shared_ptr<Loaded>& loaded) {
  const Stopwatch watch;
  return {loaded, measure(*loaded->system().table), watch};
}

}  // namespace

void add_loading(py::module_& module) {
  py::class_<Loaded, std::shared_ptr<Loaded>>(module, "Loaded")
      .def_property_readonly("name", [](const Loaded& self) { return self.system().name; })
      .def_property_readonly("title", [](const Loaded& self) { return self.system().title; })
      .def_property_readonly("toml", [](const Loaded& self) { return self.loaded.resolved_toml; })
      .def_property_readonly("engine",
                             [](const Loaded& self) { return cli::engine_of(self.system()); })
      .def("svg", [](const Loaded& self) {
        return cli::table_svg(*self.system().table, self.system().title);
      });
  py::class_<TableOutcome>(module, "TableOutcome")
      .def("json",
           [](const TableOutcome& self) {
             return cli::table_json(self.system->loaded, self.measured, "", self.watch).text();
           })
      .def("text",
           [](const TableOutcome& self) {
             return cli::table_text(self.system->system(), self.measured, "");
           })
      .def("doubts", [](const TableOutcome&) { return std::vector<std::string>(); });
  module.def("measure", &measured, py::call_guard<py::gil_scoped_release>(), py::arg("system"));
  module.def(
      "load",
      [](const std::string& toml, const std::string& name, const std::string& command,
         const Texts& set, const Texts& texts) {
        return std::const_pointer_cast<Loaded>(load(toml, name, command, set, texts));
      },
      py::call_guard<py::gil_scoped_release>(), py::arg("toml"), py::arg("name"),
      py::arg("command"), py::arg("set"), py::arg("texts"));
  module.def("systems", [] {
    std::vector<std::pair<std::string, std::string>> all;
    for (const BuiltinSystem& one : builtin_systems())
      all.emplace_back(std::string(one.name), std::string(one.toml));
    return all;
  });
  module.def("keys", [] {
    py::list all;
    for (const KeyDescription& key : key_table())
      all.append(py::make_tuple(std::string(key.section), std::string(key.kind),
                                std::string(key.key), std::string(key.type),
                                std::string(key.fallback), std::string(key.meaning)));
    return all;
  });
  module.def("counted", &base::counted, py::arg("number"), py::arg("noun"));
  module.def("nearest_name", &nearest_name, py::arg("name"), py::arg("known"));
}

}  // namespace carom::python
