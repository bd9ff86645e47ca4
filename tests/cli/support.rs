//! A folder of its own for each test, with the programs in it, and the binary run there.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A folder that is gone when the test is over.
pub(crate) struct Bench {
    folder: PathBuf,
}

/// What a run of the binary left.
pub(crate) struct Ran {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Bench {
    /// The folder of a test, with a copy of every program and workcell.
    pub(crate) fn new(test: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cli_{test}"));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("a folder");
        let programs = Path::new(env!("CARGO_MANIFEST_DIR")).join("programs");
        copy(&programs, &folder);
        Self { folder }
    }

    pub(crate) fn path(&self, file: &str) -> PathBuf {
        self.folder.join(file)
    }

    pub(crate) fn write(&self, file: &str, content: impl AsRef<[u8]>) {
        let path = self.path(file);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, content).expect("a file");
    }

    pub(crate) fn read(&self, file: &str) -> Vec<u8> {
        fs::read(self.path(file)).expect("a file")
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_obverse"));
        command.current_dir(&self.folder).args(arguments).stdin(Stdio::null());
        command
    }

    /// Run the binary in the folder.
    pub(crate) fn run(&self, arguments: &[&str]) -> Ran {
        Ran::from(self.command(arguments).output().expect("the binary runs"))
    }

    /// Run it, and it must end with this code.
    pub(crate) fn ends(&self, code: i32, arguments: &[&str]) -> Ran {
        let ran = self.run(arguments);
        assert_eq!(ran.code, code, "{arguments:?}\n{}\n{}", ran.stdout, ran.stderr);
        ran
    }

    /// Every file and what is in it.
    pub(crate) fn files(&self) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(&self.folder).expect("the folder");
        let files = entries.map(|entry| {
            let entry = entry.expect("an entry");
            let name = entry.file_name().to_string_lossy().into_owned();
            (name, fs::read(entry.path()).unwrap_or_default())
        });
        files.collect()
    }

    /// Wrong input: exit code 2, something on standard error that says all of `words`, nothing on
    /// standard output, and no file changed or made.
    pub(crate) fn refuses(&self, arguments: &[&str], words: &[&str]) {
        let before = self.files();
        let ran = self.ends(2, arguments);
        assert!(!ran.stderr.contains("panicked"), "{arguments:?}\n{}", ran.stderr);
        for word in words {
            assert!(ran.stderr.contains(word), "{arguments:?}: no `{word}` in\n{}", ran.stderr);
        }
        assert_eq!(ran.stdout, "", "{arguments:?}");
        assert!(before == self.files(), "{arguments:?} changed a file");
    }

    /// Wrong input with `--json`: exit code 2, words on standard error, and on standard output one
    /// line, a summary. What it says is wrong.
    pub(crate) fn refuses_as_json(&self, arguments: &[&str]) -> Vec<Value> {
        let ran = self.ends(2, arguments);
        assert!(!ran.stderr.is_empty(), "{arguments:?}");
        assert_eq!(ran.json().len(), 1, "{arguments:?}\n{}", ran.stdout);
        let summary = ran.summary();
        assert_eq!(summary["outcome"], "refused", "{arguments:?}");
        summary["messages"].as_array().expect("messages").clone()
    }
}

/// Copy a folder and all that is in it.
fn copy(from: &Path, to: &Path) {
    for entry in fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        let to = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            fs::create_dir_all(&to).expect("a folder");
            copy(&path, &to);
        } else {
            fs::copy(&path, to).expect("a copy");
        }
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let _ = fs::remove_dir_all(&self.folder);
        }
    }
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code().unwrap_or(-1),
            stdout: String::from_utf8(output.stdout).expect("text"),
            stderr: String::from_utf8(output.stderr).expect("text"),
        }
    }
}

impl Ran {
    /// The lines of standard output as JSON.
    pub(crate) fn json(&self) -> Vec<Value> {
        let parse = |line: &str| serde_json::from_str(line).unwrap_or_else(|_| panic!("{line}"));
        self.stdout.lines().map(parse).collect()
    }

    /// The last of them, which must be a summary.
    pub(crate) fn summary(&self) -> Value {
        let last = self.json().pop().unwrap_or_else(|| panic!("nothing\n{}", self.stderr));
        assert_eq!(last["type"], "summary", "{last}");
        last
    }
}
