#include "cli/options.hpp"

#include <fmt/format.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Version.hpp>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "carom/base/error.hpp"
#include "carom/files/system_file.hpp"
#include "carom_version.hpp"
#include "cli/command_options.hpp"
#include "cli/command_table.hpp"
#include "cli/option_faults.hpp"
#include "cli/reports/aligned.hpp"

namespace carom::cli {

namespace {

constexpr const char* introduction =
    "carom: classical particles in two dimensions. Between walls particles fly\n"
    "freely, with or without a magnetic field, and hits are found exactly. Where\n"
    "potentials or other particles act, the motion is integrated.";

constexpr const char* examples =
    "Examples:\n"
    "  carom escape magnetic-square            survival in a square with a hole\n"
    "  carom run stadium --closed --collisions 1000 -o orbit.h5\n"
    "                                          one orbit, every hit of it\n"
    "  carom table mushroom -o mushroom.svg    area, perimeter, walls; a drawing\n"
    "\n"
    "SYSTEM is a built-in name (carom systems) or a TOML file (my.toml, ./my). Any key of it can "
    "be changed: --set table.width=2 --set \"field.B=1/3\". carom COMMAND --help explains a "
    "command.";

// Help in lines that fit a terminal.
class Help : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    return beside(Formatter::make_option_desc(option));
  }
  std::string make_subcommand(const CLI::App* command) const override {
    std::stringstream out;
    CLI::detail::format_help(out, command->get_name(), beside(command->get_description()),
                             get_column_width());
    return out.str();
  }
  std::string make_footer(const CLI::App* app) const override {
    std::string text;
    for (const std::string& line : lines_of(app->get_footer())) text += folded(line, "") + "\n";
#if CLI11_VERSION_MINOR >= 4  // whose caller leaves no empty line before it
    if (!text.empty()) text.insert(0, 1, '\n');
#endif
    return text;
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = Formatter::make_option_opts(option);
    constexpr std::size_t room = line_width - 12;  // beside the option's name
    for (std::size_t from = 0; text.size() - from > room;) {
      const std::size_t bar = text.rfind('|', from + room);
      if (bar == std::string::npos || bar < from) break;
      text.insert(bar + 1, "\n" + std::string(9, ' '));
      from = bar + 2;
    }
    return text;
  }

 private:
  std::string beside(const std::string& text) const {
    return folded(text, "", line_width - get_column_width());
  }
};

std::string quoted(const std::string& word) {
  const bool plain =
      !word.empty() && word.find_first_of(" \t\n'\"\\$&|;<>()*?[]{}!#`") == std::string::npos;
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

void define(CLI::App& app, Options& o, bool& version_wanted, const std::string* only = nullptr) {
  app.formatter(std::make_shared<Help>());  // of the commands, too
  app.footer(examples);
  app.add_flag("--version", version_wanted, "Print the version");
  app.require_subcommand(0, 1);
  define_commands(app, o, only);
}

CommandRow row_of(const CLI::App& app) {
  CommandRow row{app.get_name(), app.get_description(), {}, {}, false};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // for tests
    const std::string value = option->get_type_size() > 0 ? option->get_type_name() : "";
    if (option->get_positional()) {
      row.arguments.push_back({{option->get_name(true)}, "", option->get_description()});
      row.many_arguments = option->get_items_expected_max() > 1;
      continue;
    }
    std::vector<std::string> names;
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    row.options.push_back({names, value, option->get_description()});
  }
  return row;
}

}  // namespace

std::vector<CommandRow> command_table() {
  Options options;
  bool version_wanted = false;
  CLI::App app(introduction);
  define(app, options, version_wanted);
  std::vector<CommandRow> rows{row_of(app)};
  for (const CLI::App* command : app.get_subcommands({})) rows.push_back(row_of(*command));
  return rows;
}

void set_options(Options& options, const std::string& command,
                 const std::vector<std::pair<std::string, std::string>>& texts) {
  bool version_wanted = false;
  CLI::App app(introduction);
  define(app, options, version_wanted);
  std::vector<CLI::App*> commands = app.get_subcommands([](CLI::App*) { return true; });
  std::stable_partition(commands.begin(), commands.end(),
                        [&](const CLI::App* one) { return one->get_name() == command; });
  for (const auto& [key, text] : texts) {
    std::string name = "--" + key;
    std::replace(name.begin(), name.end(), '_', '-');
    const auto owner = std::find_if(commands.begin(), commands.end(), [&](const CLI::App* one) {
      return one->get_option_no_throw(name) != nullptr;
    });
    if (owner == commands.end()) throw std::invalid_argument("no such option: " + key);
    try {
      CLI::Option& option = *(*owner)->get_option(name);
      option.clear();
      option.add_result(text);
      option.run_callback();
    } catch (const CLI::ParseError& error) {
      throw InputError(Place{"command line", 0, 0, name}, error.what(), "a value");
    }
  }
}

namespace {

// `only`: the one command whose options are made, which most of a short run's time went into; null:
// all. Nothing where they are not enough: for a fault, whose message may name other commands, or
// where another command is meant.
std::optional<Parsed> parse(int argc, char** argv, const std::string* only) {
  Parsed parsed;
  Options& options = parsed.options;
  for (int i = 0; i < argc; ++i) options.line += (i ? " " : "") + quoted(i ? argv[i] : "carom");

  CLI::App app(introduction, "carom");
  bool version_wanted = false;
  define(app, options, version_wanted, only);

  // carom help COMMAND is carom COMMAND --help.
  std::vector<char*> words(argv, argv + argc);
  static char help[] = "--help";
  if (argc > 1 && std::string(argv[1]) == "help") {
    words.erase(words.begin() + 1);
    const auto known = app.get_subcommands(
        [&](const CLI::App* one) { return argc > 2 && one->get_name() == argv[2]; });
    if (argc < 3 || !known.empty()) words.push_back(help);
    argc = static_cast<int>(words.size());
    argv = words.data();
  }
  const auto complain = [&](const std::string& message) {
    const auto chosen = app.get_subcommands();
    const std::string command = chosen.empty() ? "carom" : "carom " + chosen.front()->get_name();
    std::fprintf(stderr, "%s: %s\nTry '%s --help'.\n", command.c_str(), message.c_str(),
                 command.c_str());
    parsed.exit = usage;
  };
  try {
    try {
      app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
      throw;
    } catch (const CLI::ParseError&) {
      if (only != nullptr) return std::nullopt;
      throw;
    }
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    if (only != nullptr && !chosen.empty() && chosen.front()->get_name() != *only)
      return std::nullopt;
    std::fputs((chosen.empty() ? app.help() : chosen.front()->help("carom")).c_str(), stdout);
    parsed.exit = done;
    return parsed;
  } catch (const CLI::ExtrasError&) {
    const auto chosen = app.get_subcommands();
    std::string message = chosen.empty() ? unknown_word(app) : parted_pair(argc, argv);
    const bool before_it = !app.remaining().empty() || chosen.empty();
    if (message.empty())
      message = unknown_option(app, before_it ? app : *chosen.front(), argc, argv);
    complain(message);
    return parsed;
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string text = error.what();
    const std::size_t flag = text.find(" was given a disallowed flag override");
    if (flag != std::string::npos)
      complain("--" + text.substr(0, flag) + " takes no value");
    else
      complain(text.substr(0, text.find(':')) + " needs a value");
    return parsed;
  } catch (const CLI::ParseError& error) {
    complain(error.what());
    return parsed;
  }
  if (version_wanted) {
    std::printf("carom %s\n", version);
    parsed.exit = done;
    return parsed;
  }
  if (app.get_subcommands().empty()) {
    std::fputs(app.help().c_str(), stdout);
    parsed.exit = done;
    return parsed;
  }
  options.command = app.get_subcommands().front()->get_name();
  const bool resumes = !options.resume.empty();
  if (options.command != "systems" && options.command != "schemes" &&
      options.command != "validate" && options.command != "merge" && options.command != "page" &&
      options.system.empty() && !resumes)
    complain("SYSTEM is missing: a built-in name (carom systems) or a TOML file");
  else if (options.command == "run" && resumes && !options.system.empty())
    complain("--resume takes the system from the archive: leave SYSTEM out");
  else if (options.per_trajectory && options.output.empty() && !resumes)
    complain("--per-trajectory writes to an archive: add -o FILE.h5");
  else if (!options.checkpoint.empty() && options.output.empty() && !resumes &&
           options.splitting.empty())
    complain("--checkpoint writes to an archive: add -o FILE.h5");
  return parsed;
}

}  // namespace

Parsed parse(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "--complete") {
    std::fputs(completions(argv[2]).c_str(), stdout);
    Parsed parsed;
    parsed.exit = done;
    return parsed;
  }
  const bool help = argc > 2 && std::string(argv[1]) == "help";
  const std::string typed = argc > 1 ? argv[help ? 2 : 1] : "";
  std::optional<Parsed> parsed = parse(argc, argv, &typed);
  return parsed ? std::move(*parsed) : *parse(argc, argv, nullptr);
}

}  // namespace carom::cli
