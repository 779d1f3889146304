// Completion scripts.  All three walk the words already typed to find the command (a path such as
// "/make/torus"), then offer the values of the option before the cursor, or the command's subcommands,
// options and fixed positional values.
#include "client/cli/completions.h"

#include <CLI/CLI.hpp>

#include "client/base/error.h"
#include "client/cli/help_format.h"
#include "client/cli/value_checks.h"
#include "core/files/read/parse_shape.h"

namespace affskel::client {
namespace {

struct CompletedOption {
  std::vector<std::string> names;  // with dashes
  std::string description;
  bool takes_value = false;
  bool takes_file = false;
  std::vector<std::string> values;  // if only these are possible
};

struct CompletedCommand {
  std::string path;  // "" = top, "/submit", "/make/torus"
  std::string name;
  std::string description;
  std::vector<CompletedOption> options;  // its own and the global ones
  std::vector<std::string> positional_values;
  bool positional_file = false;  // of any kind
  bool positional_mesh = false;
  bool positional_job = false;
  std::vector<std::pair<std::string, std::string>> subcommands;  // name, description
};

bool wants_file(const CLI::Option& option) {
  const std::string type = placeholder(option);
  const std::string name = option.get_name();
  return type == "FILE" || type == "DIR" || name == "FILE" || name == "A" || name == "B";
}

void add_options(CompletedCommand& command, const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      for (const std::string& value : possible_values(*option)) command.positional_values.push_back(value);
      if (option->get_name() == "JOB") {
        command.positional_values.push_back("@last");
        command.positional_job = true;
      }
      const bool mesh = is_mesh_file(*option);
      command.positional_mesh = command.positional_mesh || mesh;
      command.positional_file = command.positional_file || (wants_file(*option) && !mesh);
      continue;
    }
    CompletedOption completed;
    for (const std::string& name : option->get_snames()) completed.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) completed.names.push_back("--" + name);
    completed.description = option->get_description();
    completed.takes_value = option->get_items_expected_max() > 0;
    completed.takes_file = wants_file(*option);
    // What is behind "=" is the user's.
    for (const std::string& value : possible_values(*option))
      completed.values.push_back(value.substr(0, std::min(value.find('='), value.size() - 1) + 1));
    command.options.push_back(std::move(completed));
  }
}

void collect(std::vector<CompletedCommand>& all, const CLI::App& app, const std::string& path) {
  CompletedCommand command;
  command.path = path;
  command.name = app.get_name();
  command.description = app.get_description();
  for (const CLI::App* level = &app; level != nullptr; level = level->get_parent()) {
    // Help exists on every level, once is enough.
    const std::size_t known = command.options.size();
    add_options(command, *level);
    if (level != &app) {
      std::erase_if(command.options, [&, i = std::size_t{0}](const CompletedOption& o) mutable {
        return i++ >= known && o.names.back() == "--help";
      });
    }
  }
  // Those of no group are for shells, not for people.
  const auto children =
      app.get_subcommands([](const CLI::App* child) { return !child->get_group().empty(); });
  for (const CLI::App* child : children)
    command.subcommands.emplace_back(child->get_name(), child->get_description());
  all.push_back(std::move(command));
  for (const CLI::App* child : children) collect(all, *child, path + "/" + child->get_name());
}

std::string join(const std::vector<std::string>& words, const std::string& between) {
  return CLI::detail::join(words, between);
}

// The extensions of mesh files, each behind a text, without its dot.
std::string mesh_patterns(const std::string& before, const std::string& between) {
  std::vector<std::string> patterns;
  const auto add = [&](std::string_view extension) {
    const std::string pattern = before + std::string(extension.substr(1));
    patterns.push_back(pattern);
    for (const std::string_view packed : core::packed_extensions())
      patterns.push_back(pattern + std::string(packed));
  };
  for (const std::string_view extension : core::mesh_extensions()) add(extension);
  for (const std::string_view extension : core::voxel_extensions()) add(extension);
  return join(patterns, between);
}

std::vector<std::string> subcommand_paths(const std::vector<CompletedCommand>& commands) {
  std::vector<std::string> paths;
  for (const CompletedCommand& c : commands) {
    if (!c.path.empty()) paths.push_back("'" + c.path + "'");
  }
  return paths;
}

// Shell patterns "path:option" that an option's names give.
std::string value_pattern(const CompletedCommand& c, const CompletedOption& o) {
  std::vector<std::string> patterns;
  for (const std::string& name : o.names) patterns.push_back("'" + c.path + ":" + name + "'");
  return join(patterns, "|");
}

// The lines of a shell's `case` that complete the values of options.
// @param reply the commands that complete those of one option, empty = none; @param open before a pattern.
template <typename Reply>
std::string value_cases(const std::vector<CompletedCommand>& commands, const char* open, Reply&& reply) {
  std::string cases;
  for (const CompletedCommand& c : commands) {
    for (const CompletedOption& o : c.options) {
      if (!o.takes_value) continue;
      const std::string answer = reply(o);
      cases += std::string("    ") + open + value_pattern(c, o) + ") " + answer +
               (answer.empty() ? "" : "; ") + "return ;;\n";
    }
  }
  return cases;
}

std::string bash_script(const std::vector<CompletedCommand>& commands) {
  std::string s =
      "# Completion of affskel-client for bash: source this file.\n_affskel_client() {\n"
      "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} at= i\n"
      "  COMPREPLY=()\n"
      "  for ((i = 1; i < COMP_CWORD; i++)); do\n    case \"$at/${COMP_WORDS[i]}\" in\n      " +
      join(subcommand_paths(commands), "|") +
      ") at+=/${COMP_WORDS[i]} ;;\n    esac\n  done\n"
      "  case \"$at:$prev\" in\n";
  s += value_cases(commands, "", [](const CompletedOption& o) -> std::string {
    if (!o.values.empty()) return "COMPREPLY=($(compgen -W '" + join(o.values, " ") + "' -- \"$cur\"))";
    return o.takes_file ? "mapfile -t COMPREPLY < <(compgen -f -- \"$cur\"); compopt -o filenames 2>/dev/null"
                        : "";
  });
  s += "  esac\n  local words= files= jobs= file\n  case \"$at\" in\n";
  for (const CompletedCommand& c : commands) {
    std::vector<std::string> words = c.positional_values;
    for (const auto& sub : c.subcommands) words.push_back(sub.first);
    std::vector<std::string> options;
    for (const CompletedOption& o : c.options) options.push_back(o.names.back());
    s += "    '" + c.path + "') words='" + join(words, " ") + "'; [[ $cur == -* ]] && words='" +
         join(options, " ") + "'" +
         (c.positional_file   ? "; files=any"
          : c.positional_mesh ? "; files=mesh"
                              : "") +
         (c.positional_job ? "; jobs=1" : "") + " ;;\n";
  }
  return s +
         "  esac\n"
         "  if [[ $jobs && $cur != -* ]]; then\n"
         "    words+=\" $(\"${COMP_WORDS[0]}\" job-ids --line \"${COMP_LINE:0:COMP_POINT}\" 2>/dev/null | "
         "cut -f 1)\"\n  fi\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n"
         "  if [[ $files && $cur != -* ]]; then\n"
         "    while IFS= read -r file; do\n"
         "      case \"$files:${file,,}\" in\n"
         "        any:*|" +
         mesh_patterns("mesh:*.", "|") +
         ") COMPREPLY+=(\"$file\") ;;\n"
         "        *) [[ -d $file ]] && COMPREPLY+=(\"$file\") ;;\n"
         "      esac\n"
         "    done < <(compgen -f -- \"$cur\")\n"
         "    compopt -o filenames 2>/dev/null\n  fi\n}\n"
         "complete -F _affskel_client affskel-client\n";
}

// For single quotes; zsh's _describe splits at colons, which a backslash prevents.
std::string quoted(const std::string& text, bool zsh) {
  std::string safe;
  for (const char c : text) {
    if (c == '\'') {
      safe += "'\\''";
    } else {
      if (zsh && c == ':') safe += '\\';
      safe += c;
    }
  }
  return safe;
}

std::string zsh_script(const std::vector<CompletedCommand>& commands) {
  std::string s =
      "#compdef affskel-client\n# Completion of affskel-client for zsh: a file named _affskel-client in "
      "$fpath, or source it.\n"
      "_affskel_client() {\n  local at= i\n  local -a found\n  for ((i = 2; i < CURRENT; i++)); do\n"
      "    case \"$at/${words[i]}\" in\n      (" +
      join(subcommand_paths(commands), "|") +
      ") at+=/${words[i]} ;;\n    esac\n  done\n"
      "  case \"$at:${words[CURRENT-1]}\" in\n";
  s += value_cases(commands, "(", [](const CompletedOption& o) -> std::string {
    if (!o.values.empty()) return "compadd -- " + join(o.values, " ");
    return o.takes_file ? "_files" : "";
  });
  s += "  esac\n  case \"$at\" in\n";
  for (const CompletedCommand& c : commands) {
    s += "    ('" + c.path + "')\n      if [[ ${words[CURRENT]} == -* ]]; then\n        found=(";
    for (const CompletedOption& o : c.options)
      s += "\n          '" + quoted(o.names.back(), true) + ":" + quoted(o.description, true) + "'";
    s += ")\n        _describe -o option found\n      else\n";
    if (!c.subcommands.empty()) {
      s += "        found=(";
      for (const auto& sub : c.subcommands)
        s += "\n          '" + sub.first + ":" + quoted(sub.second, true) + "'";
      s += ")\n        _describe command found\n";
    }
    if (!c.positional_values.empty()) s += "        compadd -- " + join(c.positional_values, " ") + "\n";
    if (c.positional_job) {
      s += "        found=(${(f)\"$(${words[1]} job-ids --line \"$BUFFER\" 2>/dev/null)\"})\n"
           "        found=(\"${(@)found/$'\\t'/:}\")\n"
           "        _describe -V job found\n";
    }
    if (c.positional_file) s += "        _files\n";
    if (c.positional_mesh) s += "        _files -g '*.(#i)(" + mesh_patterns("", "|") + ")'\n";
    s += "      fi ;;\n";
  }
  return s +
         "  esac\n}\n"
         "if [[ ${funcstack[1]} == _affskel-client ]]; then _affskel_client; else compdef _affskel_client "
         "affskel-client; fi\n";
}

std::string fish_condition(const CompletedCommand& c, const std::vector<CompletedCommand>& commands) {
  std::string condition;
  if (c.path.empty()) {
    std::vector<std::string> names;
    for (const auto& sub : commands.front().subcommands) names.push_back(sub.first);
    return "not __fish_seen_subcommand_from " + join(names, " ");
  }
  for (const std::string& word : CLI::detail::split(c.path.substr(1), '/')) {
    condition += (condition.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + word);
  }
  return condition;
}

std::string fish_script(const std::vector<CompletedCommand>& commands) {
  std::string s =
      "# Completion of affskel-client for fish: source this file.\ncomplete -c affskel-client -f\n";
  for (const CompletedCommand& c : commands) {
    const std::string head = "complete -c affskel-client -n '" + fish_condition(c, commands) + "' ";
    for (const auto& sub : c.subcommands) {
      s += head + "-a " + sub.first + " -d '" + quoted(sub.second, false) + "'\n";
    }
    if (!c.positional_values.empty()) s += head + "-a '" + join(c.positional_values, " ") + "'\n";
    if (c.positional_job)
      s += head + "-k -a '(affskel-client job-ids --line (commandline -cp) 2>/dev/null)'\n";
    if (c.positional_file) s += head + "-F\n";
    if (c.positional_mesh) s += head + "-k -a '(__fish_complete_suffix " + mesh_patterns(".", " ") + ")'\n";
    for (const CompletedOption& o : c.options) {
      s += head;
      for (const std::string& name : o.names)
        s += name.starts_with("--") ? "-l " + name.substr(2) + " " : "-s " + name.substr(1) + " ";
      if (o.takes_value) s += "-r ";
      if (o.takes_file) s += "-F ";
      if (!o.values.empty()) s += "-a '" + join(o.values, " ") + "' ";
      s += "-d '" + quoted(o.description, false) + "'\n";
    }
  }
  return s;
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  std::vector<CompletedCommand> commands;
  collect(commands, app, "");
  if (shell == "bash") return bash_script(commands);
  if (shell == "zsh") return zsh_script(commands);
  if (shell == "fish") return fish_script(commands);
  throw ClientError(ExitCode::kUsage, "no completions for '" + shell + "'; possible are bash, zsh and fish");
}

}  // namespace affskel::client
