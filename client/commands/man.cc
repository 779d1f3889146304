#include <ostream>

#include "client/cli/manual_page.h"
#include "client/commands/commands.h"

namespace affskel::client {

void add_man(CommandLine& line) {
  line.add("man", "Manual page of all commands, for man",
           "  affskel-client man | man -l -\n"
           "  affskel-client man > ~/.local/share/man/man1/affskel-client.1",
           [&line](Context& context) { context.out() << manual_page(line.app()); });
}

}  // namespace affskel::client
