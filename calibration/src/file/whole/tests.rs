use std::fs;
use std::io::{self, Write};
use std::path::Path;

use nalgebra::DMatrix;

use super::{Existing, WholeFile, write_whole};
use crate::file::{CalibrationFile, FileError, SignalUnit};

fn names(folder: &Path) -> Vec<String> {
    let all = fs::read_dir(folder).unwrap();
    let mut all: Vec<String> = all.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    all.sort();
    all
}

fn calibration() -> CalibrationFile {
    let matrix = DMatrix::from_diagonal_element(6, 6, 2.0);
    CalibrationFile::new(matrix, vec![10.0, 10.0, 10.0, 0.1, 0.1, 0.1], vec![0.0; 6], SignalUnit::Volt)
        .unwrap()
}

#[test]
fn a_file_that_is_never_finished_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tip.toml");
    fs::write(&path, "of yesterday").unwrap();
    let mut file = WholeFile::create(&path, Existing::Replace).unwrap();
    file.write_all(&vec![b'x'; 1 << 20]).unwrap();
    let beside = file.beside().unwrap().to_owned();
    assert!(beside.parent() == Some(folder.path()) && fs::metadata(&beside).unwrap().len() > 1 << 19);
    let name = beside.file_name().unwrap().to_str().unwrap();
    assert!(name.starts_with("tip.unfinished-") && name.ends_with(".toml"), "{name}");
    assert_eq!(fs::read(&path).unwrap(), b"of yesterday");
    drop(file);
    assert_eq!(names(folder.path()), ["tip.toml"]);
    assert_eq!(fs::read(&path).unwrap(), b"of yesterday");
}

#[test]
fn what_is_there_is_kept_or_replaced_as_asked() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tip");
    let mut first = WholeFile::create(&path, Existing::Keep).unwrap();
    let second = WholeFile::create(&path, Existing::Keep).unwrap();
    first.write_all(b"first").unwrap();
    first.finish().unwrap();
    // It was not there when the second was begun.
    assert_eq!(second.finish().unwrap_err().kind(), io::ErrorKind::AlreadyExists);
    let refused = WholeFile::create(&path, Existing::Keep).unwrap_err();
    assert_eq!((refused.kind(), fs::read(&path).unwrap()), (io::ErrorKind::AlreadyExists, b"first".to_vec()));
    write_whole(&path, "second").unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"second");
    assert_eq!(names(folder.path()), ["tip"]);
    let error = write_whole(folder.path(), "").unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::IsADirectory);
    let error = write_whole(folder.path().join("none").join("tip"), "").unwrap_err();
    assert!(error.kind() == io::ErrorKind::NotFound && !error.to_string().contains("unfinished"), "{error}");
}

#[test]
fn a_calibration_is_read_as_it_was_or_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tip.toml");
    let old = calibration();
    old.write(&path).unwrap();
    let mut new = old.clone();
    new.zero[2] = 0.25;
    new.write(&path).unwrap();
    assert_eq!(CalibrationFile::read(&path).unwrap(), new);
    // What is no calibration is not written, and the old one stays.
    let mut bad = new.clone();
    bad.zero[2] = f64::NAN;
    assert!(matches!(bad.write(&path), Err(FileError::NotFinite { .. })));
    assert_eq!(CalibrationFile::read(&path).unwrap(), new);
    assert_eq!(names(folder.path()), ["tip.toml"]);
}

#[cfg(unix)]
#[test]
fn rights_stay_and_links_stay_links() {
    use std::os::unix::fs::{PermissionsExt, symlink};

    let folder = tempfile::tempdir().unwrap();
    let [real, link, plain] = ["real.toml", "link.toml", "plain.toml"].map(|name| folder.path().join(name));
    let rights = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    fs::write(&real, "old").unwrap();
    fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
    symlink("real.toml", &link).unwrap();
    calibration().write(&link).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!((CalibrationFile::read(&real).unwrap(), rights(&real)), (calibration(), 0o640));
    // A new file has the rights of any other, or is its owner's alone.
    fs::write(folder.path().join("other"), "").unwrap();
    calibration().write(&plain).unwrap();
    assert_eq!(rights(&plain), rights(&folder.path().join("other")));
    let secret = folder.path().join("secret");
    WholeFile::create_private(&secret, Existing::Keep).unwrap().finish().unwrap();
    assert_eq!(rights(&secret), 0o600);
}

/// A disk that is full says so, and what was there stays: here the disk is a device that takes nothing.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told() {
    let error = write_whole("/dev/full", "text").unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    let error = calibration().write("/dev/full").unwrap_err().to_string();
    assert!(error.contains("/dev/full") && error.contains("No space left"), "{error}");
}
