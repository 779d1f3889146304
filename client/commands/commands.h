#pragma once

#include <array>

#include "client/commands/command_line.h"

namespace affskel::client {

// The commands.  Each adds itself, its options and its action, in the file of its name.

using AddCommand = void (*)(CommandLine& line);

void add_submit(CommandLine& line);
void add_list(CommandLine& line);
void add_status(CommandLine& line);
void add_watch(CommandLine& line);
void add_log(CommandLine& line);
void add_cancel(CommandLine& line);
void add_resume(CommandLine& line);
void add_delete(CommandLine& line);
void add_verify(CommandLine& line);
void add_pin(CommandLine& line);
void add_unpin(CommandLine& line);
void add_fetch(CommandLine& line);
void add_skeleton(CommandLine& line);
void add_surface(CommandLine& line);
void add_measure(CommandLine& line);
void add_erode(CommandLine& line);
void add_render(CommandLine& line);
void add_view(CommandLine& line);
void add_inspect(CommandLine& line);
void add_repair(CommandLine& line);
void add_make(CommandLine& line);
void add_compare(CommandLine& line);
void add_transform(CommandLine& line);
void add_perturb(CommandLine& line);
void add_server_info(CommandLine& line);
void add_health(CommandLine& line);
void add_web(CommandLine& line);
void add_completions(CommandLine& line);
void add_man(CommandLine& line);
void add_job_ids(CommandLine& line);

/// All of them, in the order of the help.
inline constexpr std::array kCommands = {
    add_submit,   add_list,        add_status,  add_watch,       add_log,       add_verify,
    add_cancel,   add_resume,      add_delete,  add_pin,         add_unpin,     add_fetch,
    add_skeleton, add_surface,     add_measure, add_erode,       add_render,    add_view,
    add_inspect,  add_repair,      add_make,    add_compare,     add_transform, add_perturb,
    add_web,      add_server_info, add_health,  add_completions, add_man,       add_job_ids};

}  // namespace affskel::client
