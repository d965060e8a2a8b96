#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <sstream>

#include "carom/files/system_file.hpp"
#include "carom_version.hpp"
#include "cli/manual/manual.hpp"

namespace carom::cli::manual {

namespace {

// Plain text as roff: dashes are those that can be typed, other characters than ASCII by number.
std::string escaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte >= 0xc0) {  // UTF-8: the first byte says how many follow
      const int more = byte >= 0xf0 ? 3 : byte >= 0xe0 ? 2 : 1;
      std::uint32_t code = byte & (0x3fu >> more);
      for (int k = 0; k < more; ++k)
        code = code << 6 | (static_cast<unsigned char>(text.at(++i)) & 0x3fu);
      out += fmt::format("\\[u{:04X}]", code);
    } else if (byte == '-') {
      out += "\\-";
    } else if (byte == '\\') {
      out += "\\e";
    } else if (byte == '\'') {
      out += "\\(aq";
    } else if (byte == '^') {
      out += "\\(ha";
    } else if (byte == '~') {
      out += "\\(ti";
    } else if (byte == '`') {
      out += "\\(ga";
    } else {
      out += text[i];
    }
  }
  return out;
}

// A line of text: a dot at its start would be a request.
std::string line_of(const std::string& text) {
  return (text.starts_with('.') ? "\\&" : "") + escaped(text) + "\n";
}

// Lines that begin with two spaces stay as they are; others are paragraphs, which an empty line
// ends.
std::string paragraphs(const std::string& text) {
  enum { between, filled, kept } before = between, now = between;
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); before = now) {
    now = line.empty() ? between : line.starts_with("  ") ? kept : filled;
    if (before == kept && now != kept) out += ".EE\n.RE\n";
    if (now == kept && before != kept) out += ".RS 2\n.EX\n";
    if (now == filled && before != filled) out += ".PP\n";
    if (now != between) out += line_of(now == kept ? line.substr(2) : line);
  }
  return now == kept ? out + ".EE\n.RE\n" : out;
}

std::string names_of(const OptionRow& option) {
  std::string out;
  for (const std::string& name : option.names)
    out += (out.empty() ? "\\fB" : ", \\fB") + escaped(name) + "\\fR";
  if (!option.value.empty()) out += " \\fI" + escaped(option.value) + "\\fR";
  return out;
}

std::string paragraph_of(const OptionRow& option) {
  return ".TP\n" + names_of(option) + "\n" + line_of(option.help);
}

// Options that at least three commands have, with the same value and the same text.
std::vector<OptionRow> common_options(const std::vector<CommandRow>& table) {
  std::vector<OptionRow> common;
  for (const CommandRow& command : table)
    for (const OptionRow& option : command.options) {
      const auto has_it = [&](const CommandRow& other) {
        return std::count(other.options.begin(), other.options.end(), option) > 0;
      };
      if (std::count(common.begin(), common.end(), option) == 0 &&
          std::count_if(table.begin(), table.end(), has_it) >= 3)
        common.push_back(option);
    }
  return common;
}

std::string section_of(const CommandRow& command, const std::vector<OptionRow>& common) {
  std::string out = fmt::format(".SS \"carom {}\"\n.B carom {}\n[\\fIOPTIONS\\fR]", command.name,
                                escaped(command.name));
  for (const OptionRow& argument : command.arguments)
    out += fmt::format(" [\\fI{}\\fR]", escaped(argument.names.front()));
  out += "\n.PP\n" + line_of(command.text + ".");
  for (const OptionRow& argument : command.arguments)
    out += ".TP\n\\fI" + escaped(argument.names.front()) + "\\fR\n" + line_of(argument.help);
  std::string shared;
  for (const OptionRow& option : command.options) {
    if (std::count(common.begin(), common.end(), option) == 0) {
      out += paragraph_of(option);
    } else {
      shared += (shared.empty() ? "\\fB" : ", \\fB") + escaped(option.names.back()) + "\\fR";
    }
  }
  if (!shared.empty()) out += ".PP\nCommon options: " + shared + "\n";
  return out + paragraphs(command.details);
}

constexpr const char* exit_status = R"(.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
Bad input: the message names the file, line and key, or the option.
.TP
.B 2
Wrong usage: an unknown command or option.
.TP
.B 3
The result cannot be trusted: a trajectory could not be followed, an energy changed by more than its
tolerance, or a case of the validation failed.
.TP
.B 130
Interrupted; what was finished is printed and stored.
.SH ENVIRONMENT
.TP
.B OMP_NUM_THREADS
Number of threads where
.B \-\-threads
is not given.
.TP
.B CAROM_PYTHON
The Python that draws pictures.
)";

}  // namespace

std::string man_page(const std::vector<CommandRow>& table) {
  const std::vector<OptionRow> common = common_options(table);
  const CommandRow& program = table.front();
  // "carom: what it is. More."
  const std::size_t colon = program.text.find(": "), dot = program.text.find(". ");
  std::string out =
      fmt::format(".TH CAROM 1 \"\" \"carom {}\" \"User Commands\"\n.nh\n.SH NAME\ncarom \\- {}\n",
                  version, escaped(program.text.substr(colon + 2, dot - colon - 2)));
  out += ".SH SYNOPSIS\n.B carom\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR] [\\fISYSTEM\\fR]\n";
  out +=
      ".SH DESCRIPTION\n" + paragraphs(program.text.substr(dot + 2)) + paragraphs(program.details);
  for (const OptionRow& option : program.options) out += paragraph_of(option);
  out += ".SH COMMANDS\n";
  for (std::size_t i = 1; i < table.size(); ++i) out += section_of(table[i], common);
  out += ".SH COMMON OPTIONS\nOptions of several commands.\n";
  for (const OptionRow& option : common) out += paragraph_of(option);
  out += ".SH BUILT\\-IN SYSTEMS\n";
  for (const BuiltinSystem& system : builtin_systems()) {
    const std::string name(system.name);
    out += ".TP\n.B " + escaped(name) + "\n" + line_of(load_system(name).system.title);
  }
  return out + exit_status;
}

}  // namespace carom::cli::manual
