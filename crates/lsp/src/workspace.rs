//! What is open in an editor, and the programs that it belongs to. Data in, data out: what is asked
//! of a program stands in modules of their own, and how editors talk in `server`.

use crate::disk::{Disk, Lacking, NoDisk, OpenFirst};
use crate::program::Program;
use crate::uri::{LIBRARY_SCHEME, path_of, split, uri_of};
use lsp_types::{TextDocumentContentChangeEvent, Uri};
use obverse_compiler::{Loader, library};
use obverse_syntax::imports;
use obverse_syntax::sources::Sources;
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

/// How many folders above a file programs are looked for that import it.
const FOLDERS_ABOVE: usize = 3;

/// A text that is open.
#[derive(Clone, Debug)]
pub(crate) struct Document {
    /// As the editor calls it.
    pub(crate) uri: Uri,
    /// Which version of it.
    pub(crate) version: i32,
    /// Its text.
    pub(crate) text: String,
}

/// What is open, and what is known of it. Files are called by keys: their path, and for what is no
/// file the address.
pub struct Workspace {
    disk: Box<dyn Disk>,
    open: BTreeMap<String, Document>,
    /// By the key of the file that a program begins in.
    programs: HashMap<String, Rc<Program>>,
    /// By the same: the newest that compiled.
    newest: HashMap<String, Rc<Program>>,
    /// The files that programs begin in which a file is part of.
    roots: HashMap<String, Vec<String>>,
    /// Whether the editor can be told that no parameter is at hand.
    pub(crate) can_have_none_active: bool,
}

/// A file of a program.
pub(crate) struct InProgram {
    /// The program.
    pub(crate) program: Rc<Program>,
    /// Which of its files.
    pub(crate) file: usize,
}

impl Workspace {
    /// Nothing is open yet.
    #[must_use]
    pub fn new(disk: Box<dyn Disk>) -> Self {
        Self {
            disk,
            open: BTreeMap::new(),
            programs: HashMap::new(),
            newest: HashMap::new(),
            roots: HashMap::new(),
            can_have_none_active: false,
        }
    }

    /// A text is opened.
    pub fn open(&mut self, uri: Uri, version: i32, text: String) {
        self.open.insert(key_of(&uri), Document { uri, version, text });
        self.forget();
    }

    /// A text is closed: what counts is what lies on the disk.
    pub fn close(&mut self, uri: &Uri) {
        self.open.remove(&key_of(uri));
        self.newest.clear();
        self.forget();
    }

    /// A text is changed, in this order. What is not open is left alone.
    pub fn change(
        &mut self,
        uri: &Uri,
        version: i32,
        changes: Vec<TextDocumentContentChangeEvent>,
    ) {
        let key = key_of(uri);
        let Some(document) = self.open.get_mut(&key) else { return };
        let before = imported(&document.text);
        document.version = version;
        for change in changes {
            match change {
                TextDocumentContentChangeEvent::TextDocumentContentChangePartial(part) => {
                    crate::position::replace(&mut document.text, part.range, &part.text);
                }
                TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(whole) => {
                    document.text = whole.text;
                }
            }
        }
        if imported(&document.text) != before {
            return self.forget();
        }
        self.programs.retain(|_, program| program.file_of(&key).is_none());
    }

    /// Files on the disk may be others than they were.
    pub fn forget(&mut self) {
        self.programs.clear();
        self.roots.clear();
    }

    /// A text that is open, by its key.
    pub(crate) fn document(&self, key: &str) -> Option<&Document> {
        self.open.get(key)
    }

    /// The keys of what is open.
    pub(crate) fn keys(&self) -> Vec<String> {
        self.open.keys().cloned().collect()
    }

    /// The address of a file by its key.
    pub(crate) fn uri(&self, key: &str) -> Uri {
        if let Some(name) = key.strip_prefix(library::PREFIX) {
            return Uri(format!("{LIBRARY_SCHEME}{name}"));
        }
        self.open.get(key).map_or_else(|| uri_of(key), |document| document.uri.clone())
    }

    /// An open file in the first of the programs that it is part of.
    pub(crate) fn file(&mut self, uri: &Uri) -> Option<InProgram> {
        self.files(uri).into_iter().next()
    }

    /// An open file in all of the programs that it is part of.
    pub(crate) fn files(&mut self, uri: &Uri) -> Vec<InProgram> {
        let key = key_of(uri);
        if !self.open.contains_key(&key) {
            return Vec::new();
        }
        let roots = self.roots_of(&key);
        let mut found = Vec::new();
        for root in roots {
            let Some(program) = self.program(&root) else { continue };
            let file = program.file_of(&key);
            found.extend(file.map(|file| InProgram { program, file }));
        }
        if found.is_empty() {
            // What was thought to import it does not, or not any more.
            found.extend(self.program(&key).map(|program| InProgram { program, file: 0 }));
        }
        found
    }

    /// The program that begins in a file.
    fn program(&mut self, root: &str) -> Option<Rc<Program>> {
        if let Some(known) = self.programs.get(root) {
            return Some(Rc::clone(known));
        }
        let program = self.compiled(root, None)?.after(self.newest.get(root).cloned());
        let program = Rc::new(program);
        if program.compiled.module.is_some() {
            self.newest.insert(root.to_owned(), Rc::clone(&program));
        }
        self.programs.insert(root.to_owned(), Rc::clone(&program));
        Some(program)
    }

    /// What a program asks of its workcell that this has not; of a program that is in no folder, or
    /// does not compile, nothing is known.
    pub(crate) fn lacking(&self, program: &Program) -> Vec<Lacking> {
        let root = program.key(0);
        let is_file = path_of(&self.uri(&root)).is_some();
        let module = program.compiled.module.as_ref().filter(|_| is_file);
        module.map_or_else(Vec::new, |module| self.disk.lacking(&root, module))
    }

    /// The program that begins in a file, with other texts in place of those that are open.
    pub(crate) fn compiled(
        &self,
        root: &str,
        instead: Option<&BTreeMap<String, Document>>,
    ) -> Option<Program> {
        let open = instead.unwrap_or(&self.open);
        let mut loader = self.loader(root, open);
        let text = match open.get(root) {
            Some(document) => document.text.clone(),
            None => loader.read(split(root).1).ok()?,
        };
        Some(Program::new(root, &text, &mut loader))
    }

    /// What is open, to be changed for [`Workspace::compiled`].
    pub(crate) fn copy_of_open(&self) -> BTreeMap<String, Document> {
        self.open.clone()
    }

    fn loader<'t>(&self, root: &str, open: &'t BTreeMap<String, Document>) -> OpenFirst<'t> {
        let is_file = open.get(root).is_none_or(|document| path_of(&document.uri).is_some());
        let disk = if is_file { self.disk.folder_of(root) } else { Box::new(NoDisk) };
        OpenFirst { folder: split(root).0.to_owned(), open, disk }
    }

    /// The files that programs begin in which a file is part of; the file itself if nothing
    /// imports it.
    pub(crate) fn roots_of(&mut self, key: &str) -> Vec<String> {
        if let Some(known) = self.roots.get(key) {
            return known.clone();
        }
        let roots = self.find_roots(key);
        self.roots.insert(key.to_owned(), roots.clone());
        roots
    }

    fn find_roots(&self, key: &str) -> Vec<String> {
        // What imports a file lies in its folder or above: nothing leads out of a program's folder.
        let mut texts: BTreeMap<String, String> = BTreeMap::new();
        let mut folder = split(key).0;
        for _ in 0..=FOLDERS_ABOVE {
            if folder.is_empty() || path_of(&uri_of(key)).as_deref() != Some(key) {
                break;
            }
            for (name, text) in self.disk.sources(folder) {
                texts.insert(crate::uri::join(folder, &name), text);
            }
            folder = split(folder).0;
        }
        texts.extend(self.open.iter().map(|(key, document)| (key.clone(), document.text.clone())));
        let files: BTreeMap<&String, Vec<String>> = texts
            .iter()
            .filter(|(root, text)| *root != key && text.contains("import"))
            .map(|(root, text)| (root, self.files_of(root, text)))
            .collect();
        let imports = |root: &str, other: &str| {
            files.iter().any(|(one, of)| {
                one.as_str() == root && of.iter().skip(1).any(|file| file == other)
            })
        };
        let importers: Vec<&String> =
            files.keys().copied().filter(|root| imports(root, key)).collect();
        let is_outermost = |root: &&&String| !importers.iter().any(|other| imports(other, root));
        let roots: Vec<String> =
            importers.iter().filter(is_outermost).map(|root| (*root).clone()).collect();
        if roots.is_empty() { vec![key.to_owned()] } else { roots }
    }

    /// The keys of the files of a program.
    fn files_of(&self, root: &str, text: &str) -> Vec<String> {
        let (folder, name) = split(root);
        let names = obverse_compiler::files(name, text, &mut self.loader(root, &self.open));
        names.iter().map(|name| crate::uri::join(folder, name)).collect()
    }
}

/// By what name a file is called here.
pub(crate) fn key_of(uri: &Uri) -> String {
    path_of(uri).unwrap_or_else(|| uri.0.clone())
}

/// What a text imports.
fn imported(text: &str) -> Vec<(bool, String)> {
    if !text.contains("import") {
        return Vec::new();
    }
    let sources = Sources::one("", text);
    imports(&sources, 0).iter().map(|one| (one.is_library, one.path.value.to_owned())).collect()
}
