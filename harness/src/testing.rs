//! Helpers of tests in several modules.

use std::fs;
use std::path::Path;

/// The names in a folder, in their order.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The files that a page links to, all of them in its folder; places within the page exist, and nothing is fetched from a network.
pub(crate) fn linked_files(page: &str, folder: &Path) -> Vec<String> {
    assert!(!page.contains("http://") && !page.contains("https://"));
    let mut files = Vec::new();
    for link in page.split("href=\"").skip(1).map(|rest| rest.split('"').next().unwrap()) {
        match link.strip_prefix('#') {
            Some(id) => assert!(page.contains(&format!("id=\"{id}\"")), "{link}"),
            None if link.starts_with("data:") => {}
            None => {
                assert!(folder.join(link).is_file(), "{link}");
                files.push(link.to_owned());
            }
        }
    }
    files
}
