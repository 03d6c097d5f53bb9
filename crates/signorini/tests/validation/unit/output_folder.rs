//! Of `output::folder`.

use signorini::output::folder::{Earlier, Folder, OutputError, date};

#[test]
fn a_folder_of_others_is_refused_and_one_of_ours_is_reused() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("out");
    let folder = Folder::create(&path).unwrap();
    folder.write("fields/a.vtu", b"x").unwrap();
    folder.log(&serde_json::json!({"event": "test"})).unwrap();
    Folder::create(&path).unwrap();
    assert!(!path.join("fields").exists());
    std::fs::write(path.join("thesis.tex"), "precious").unwrap();
    assert!(matches!(Folder::create(&path), Err(OutputError::Foreign { .. })));
    assert!(path.join("thesis.tex").exists());
    let other = root.path().join("other");
    std::fs::create_dir(&other).unwrap();
    std::fs::write(other.join("summary.json"), "{}").unwrap();
    assert!(Folder::create(&other).is_err());
}

#[test]
fn earlier_results_are_known_by_their_case_and_date() {
    assert_eq!(date(0), "1970-01-01 at 00:00 UTC");
    assert_eq!(date(951_868_799), "2000-02-29 at 23:59 UTC");
    assert_eq!(date(951_868_800), "2000-03-01 at 00:00 UTC");
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("out");
    assert_eq!(Earlier::in_folder(&path), None);
    let folder = Folder::create(&path).unwrap();
    assert_eq!(Earlier::in_folder(&path).unwrap().case, None);
    folder.write("summary.json", b"{\"case\": \"A disc\"}").unwrap();
    assert_eq!(Earlier::in_folder(&path).unwrap().case.unwrap(), "`A disc`");
}

/// Every write to /dev/full fails as on a full disk.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_leaves_the_earlier_file() {
    let root = tempfile::tempdir().unwrap();
    let folder = Folder::create(&root.path().join("out")).unwrap();
    folder.write("summary.json", b"earlier").unwrap();
    std::os::unix::fs::symlink("/dev/full", folder.path().unwrap().join("summary.json.part")).unwrap();
    let error = folder.write("summary.json", b"later").unwrap_err();
    assert!(error.to_string().contains("summary.json") && error.to_string().contains("space"), "{error}");
    assert_eq!(std::fs::read(folder.path().unwrap().join("summary.json")).unwrap(), b"earlier");
    assert!(!folder.path().unwrap().join("summary.json.part").exists());
}

#[test]
fn a_folder_in_memory_keeps_what_is_written_whole() {
    let folder = Folder::in_memory();
    assert!(folder.keeps() && folder.path().is_none() && !Folder::default().keeps());
    folder.write("pictures/a.png", b"x").unwrap();
    folder.log(&serde_json::json!({"event": "test"})).unwrap();
    let files: Vec<_> = folder.clone().take_files().into_iter().collect();
    assert_eq!(files, [("pictures/a.png".to_string(), b"x".to_vec())]);
    assert!(folder.take_files().is_empty());
}
