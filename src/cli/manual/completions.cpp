#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/manual/candidates.hpp"
#include "cli/manual/manual.hpp"

namespace carom::cli::manual {

namespace {

std::vector<std::string> command_names(const std::vector<CommandRow>& table) {
  std::vector<std::string> names;
  for (const CommandRow& command : table)
    if (!command.name.empty()) names.push_back(command.name);
  return names;
}

std::vector<std::string> option_names(const CommandRow& command, bool with_values_alone) {
  std::vector<std::string> names;
  for (const OptionRow& option : command.options)
    if (!with_values_alone || !option.value.empty())
      names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

// The shell's line that offers candidates for the word.
std::string offer(const Candidates& candidates) {
  std::string line;
  if (candidates.systems) line += "_carom_words \"$systems\"; ";
  if (!candidates.words.empty())
    line += fmt::format("_carom_words '{}'; ", fmt::join(candidates.words, " "));
  if (candidates.files)
    line += fmt::format("_carom_files {}; ", fmt::join(candidates.endings, " "));
  return line;
}

std::string bash_case(const CommandRow& command) {
  std::string out = fmt::format("    {})\n", command.name.empty() ? "''" : command.name);
  out += fmt::format("      options='{}'\n", fmt::join(option_names(command, false), " "));
  out += fmt::format("      valued=' {} '\n", fmt::join(option_names(command, true), " "));
  if (!command.arguments.empty())
    out += fmt::format("      most={}\n", command.many_arguments ? 1000 : command.arguments.size());
  out += "      ;;\n";
  return out;
}

std::string bash_values(const CommandRow& command) {
  std::string out;
  for (const OptionRow& option : command.options) {
    const std::string line = offer(candidates_of(option.value));
    if (line.empty()) continue;
    std::vector<std::string> words;
    for (const std::string& name : option.names) words.push_back(command.name + ":" + name);
    out += fmt::format("    {}) {};;\n", fmt::join(words, " | "), line);
  }
  for (const OptionRow& argument : command.arguments)
    out +=
        fmt::format("    {}:) {};;\n", command.name, offer(candidates_of(argument.names.front())));
  return out;
}

constexpr const char* bash_functions =
    R"(# Completion of carom for bash, made from the program's table of options.

# Offers those of the words in $1 that begin as $word does.
_carom_words() { COMPREPLY+=($(compgen -W "$1" -- "$word")); }

# Offers folders, and files with one of the endings given (none: all files).
_carom_files() {
  local file ending
  compopt -o filenames 2>/dev/null
  while IFS= read -r file; do
    if [[ $# -eq 0 || -d $file ]]; then COMPREPLY+=("$file"); fi
    for ending; do
      if [[ -f $file && $file == *.$ending ]]; then COMPREPLY+=("$file"); fi
    done
  done < <(compgen -f -- "$word")
}

)";

constexpr const char* bash_begin =
    R"(  # bash takes --option=VALUE and a:b for three words. Nothing is offered within a:b.
  if [[ $word == : || $before == : ]]; then
    return
  elif [[ $word == = ]]; then
    word=
  elif [[ $before == = ]]; then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    if [[ ${COMP_WORDS[i]} != -* ]]; then command=${COMP_WORDS[i]}; break; fi
  done
)";

constexpr const char* bash_end =
    R"(  # What is wanted: the value of an option, an option, or an argument that is still missing.
  if [[ $valued == *" $before "* ]]; then
    wanted=$command:$before
  elif [[ $word == -* ]]; then
    _carom_words "$options"
    return
  else
    for ((i = i + 1; i < COMP_CWORD; ++i)); do
      if [[ $valued == *" ${COMP_WORDS[i]} "* ]]; then
        if [[ ${COMP_WORDS[i + 1]} == = ]]; then i=$((i + 1)); fi
        i=$((i + 1))
      elif [[ ${COMP_WORDS[i]} == : ]]; then
        i=$((i + 1))
      elif [[ ${COMP_WORDS[i]} != -* ]]; then
        given=$((given + 1))
      fi
    done
    if ((given >= most)); then
      _carom_words "$options"
      return
    fi
    wanted=$command:
  fi
)";

}  // namespace

std::string bash_completion(const std::vector<CommandRow>& table) {
  const std::string commands = fmt::format("{}", fmt::join(command_names(table), " "));
  std::string out = bash_functions;
  out +=
      "_carom() {\n  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}\n";
  out += "  local i command= options= valued= wanted= given=0 most=0\n";
  out += fmt::format("  local commands='{} help'\n  local systems='{}'\n  COMPREPLY=()\n", commands,
                     fmt::join(system_names(), " "));
  out += bash_begin;
  out += "  case $command in\n";
  for (const CommandRow& command : table) out += bash_case(command);
  out += "    help) most=1 ;;\n    *) return ;;\n  esac\n";
  out += "  if [[ -z $command ]]; then most=1; fi\n";
  out += bash_end;
  out += "  case $wanted in\n    : | help:) _carom_words \"$commands\" ;;\n";
  for (const CommandRow& command : table) out += bash_values(command);
  return out + "  esac\n}\ncomplete -F _carom carom\n";
}

namespace {

// Text in an argument of _arguments: in single quotes, with brackets and colons escaped.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out;
}

// What completes a value or an argument: "message:action".
std::string zsh_action(const std::string& shown) {
  const Candidates candidates = candidates_of(shown);
  const std::string message = zsh_text(shown);
  if (!candidates.words.empty())
    return fmt::format("{}:({})", message, fmt::join(candidates.words, " "));
  // (toml) at the end of a pattern would be a qualifier.
  const bool one = candidates.endings.size() == 1;
  const std::string pattern = fmt::format("\"*.{}{}{}\"", one ? "" : "(",
                                          fmt::join(candidates.endings, "|"), one ? "" : ")");
  // A blank before a function keeps options of zsh's own out of its arguments.
  if (candidates.systems && candidates.files)
    return fmt::format("{}: _carom_sources {}", message, pattern);
  if (candidates.systems) return message + ":_carom_systems";
  if (candidates.files)
    return message + ":_files" + (candidates.endings.empty() ? "" : " -g " + pattern);
  return message + ": ";
}

std::string zsh_arguments(const CommandRow& command) {
  std::string out;
  for (const OptionRow& option : command.options) {
    const std::string value = option.value.empty() ? "" : ":" + zsh_action(option.value);
    const std::string rest = fmt::format("'[{}]{}'", zsh_text(option.help), value);
    const std::string repeated = option.names.front() == "--set" ? "*" : "";
    for (const std::string& name : option.names) {
      const std::string equals = option.value.empty() || !name.starts_with("--") ? "" : "=";
      const std::string others =
          repeated.empty() ? fmt::format("({})", fmt::join(option.names, " ")) : repeated;
      out += fmt::format(" \\\n        '{}'{}{}{}", others, name, equals, rest);
    }
  }
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    const std::string& shown = command.arguments[i].names.front();
    out += fmt::format(" \\\n        '{}:{}'",
                       command.many_arguments ? "*" : fmt::format("{}", i + 1), zsh_action(shown));
  }
  return out;
}

constexpr const char* zsh_begin = R"(#compdef carom
# Completion of carom for zsh, made from the program's table of options.

)";

constexpr const char* zsh_sources = R"(# A built-in system, or a file whose name matches $1.
_carom_sources() {
  _alternative 'systems:built-in system:_carom_systems' "files:file:_files -g '$1'"
}

)";

}  // namespace

std::string zsh_completion(const std::vector<CommandRow>& table) {
  std::string out = zsh_begin;
  out +=
      fmt::format("_carom_systems() {{\n  local -a systems=({})\n", fmt::join(system_names(), " "));
  out += "  _describe 'built-in system' systems\n}\n\n";
  out += zsh_sources;
  out += "_carom_commands() {\n  local -a commands=(\n";
  for (const CommandRow& command : table)
    if (!command.name.empty())
      out += fmt::format("    '{}:{}'\n", command.name, zsh_text(command.text));
  out += "    'help:Explains a command'\n  )\n  _describe command commands\n}\n\n";
  out += "_carom() {\n  local curcontext=$curcontext state line\n  local -A opt_args\n";
  out += "  _arguments -C" + zsh_arguments(table.front()) +
         " \\\n        '1:command:_carom_commands' '*:: :->command'\n";
  out += "  [[ $state == command ]] || return\n  case $words[1] in\n";
  for (const CommandRow& command : table)
    if (!command.name.empty())
      out += fmt::format("    {})\n      _arguments{}\n      ;;\n", command.name,
                         zsh_arguments(command));
  return out + "    help) _arguments '1:command:_carom_commands' ;;\n  esac\n}\n\n_carom \"$@\"\n";
}

}  // namespace carom::cli::manual
