"""That thread_safety.py finds a guarded member that is used without its mutex, and no fault where there is none.

Usage: thread_safety_test.py CLANG++
"""
import json
import os
import shutil
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import thread_safety  # noqa: E402

HEADER = """#include "base/mutex.h"
class Count {
 public:
  void add();
  int value();

 private:
  affskel::base::Mutex mutex_;
  int value_ ABSL_GUARDED_BY(mutex_) = 0;
};
"""
ADD = '#include "count.h"\nvoid Count::add() {\n  const affskel::base::MutexLock lock(mutex_);\n  ++value_;\n}\n'
VALUE = '#include "count.h"\nint Count::value() { return value_; }\n'
OTHER = "int main() { return 0; }\n"


class ThreadSafety(unittest.TestCase):
    def test_faults(self):
        with tempfile.TemporaryDirectory() as project:
            files = {"server/count.h": HEADER, "server/add.cc": ADD, "server/value.cc": VALUE, "server/other.cc": OTHER}
            for path, text in files.items():
                os.makedirs(os.path.join(project, os.path.dirname(path)), exist_ok=True)
                with open(os.path.join(project, path), "w", encoding="utf-8") as out:
                    out.write(text)
            os.makedirs(os.path.join(project, "proto/base"))
            shutil.copy(os.path.join(HERE, "../../proto/base/mutex.h"), os.path.join(project, "proto/base"))
            commands = [{"directory": project, "file": os.path.join(project, path),
                         "command": f"c++ -std=c++20 -I{project}/proto -o x.o -c {path}"}
                        for path in files if path.endswith(".cc")]
            with open(os.path.join(project, "compile_commands.json"), "w", encoding="utf-8") as out:
                json.dump(commands, out)
            said = thread_safety.analyse(project, project, CLANG)
            self.assertEqual(sorted(said), ["server/add.cc", "server/value.cc"])
            self.assertEqual(said["server/add.cc"], "")
            self.assertIn("requires holding mutex 'mutex_'", said["server/value.cc"])


if __name__ == "__main__":
    CLANG = sys.argv.pop(1)
    unittest.main()
