"""Files are written whole or not at all."""

from __future__ import annotations

import errno
import os
import signal
import stat
import subprocess
import sys
import textwrap

import pytest

from contactlab.outcome import files
from contactlab.outcome.files import content, distinct, replace_file, unwritable, write_table

OLD = "old and whole\n"


@pytest.fixture
def old(tmp_path):
    path = tmp_path / "result.csv"
    path.write_text(OLD)
    return path


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_an_error_in_the_middle_leaves_the_old_file_and_no_other(old):
    def half():
        with replace_file(old) as stream:
            stream.write("new")
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with pytest.raises(OSError, match="No space left") as caught:
        half()
    assert str(caught.value) == f"[Errno {errno.ENOSPC}] No space left on device: {str(old)!r}"
    assert old.read_text() == OLD
    assert names(old.parent) == ["result.csv"]


@pytest.mark.skipif(os.name == "nt", reason="POSIX limits")
def test_a_file_that_cannot_be_written_to_its_end_leaves_the_old_one(old):
    """A limit on the size of files fails a write as a full disk does: in the middle."""
    done = python(
        f"""
        import resource
        resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
        try:
            with replace_file({str(old)!r}) as stream:
                stream.write("x" * 1_000_000)
        except OSError as error:
            print("refused:", error)
        """
    )
    assert done.stdout.startswith("refused:")
    assert str(old) in done.stdout
    assert old.read_text() == OLD
    assert names(old.parent) == ["result.csv"]


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_killed_in_the_middle_leaves_the_old_file(old):
    done = python(
        f"""
        with replace_file({str(old)!r}) as stream:
            stream.write("x" * 1_000_000)
            stream.flush()
            os.kill(os.getpid(), {int(signal.SIGKILL)})
        """
    )
    assert done.returncode == -signal.SIGKILL
    assert old.read_text() == OLD


def python(code):
    head = "import os\nfrom contactlab.outcome.files import replace_file\n"
    program = head + textwrap.dedent(code)
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )


@pytest.mark.skipif(os.name == "nt", reason="POSIX permissions")
def test_permissions_are_those_of_the_old_file_or_of_the_umask(old, tmp_path):
    old.chmod(0o640)
    before = os.umask(0o027)
    try:
        for path in (old, tmp_path / "new.csv"):
            with replace_file(path) as stream:
                stream.write("new")
    finally:
        os.umask(before)
    assert stat.S_IMODE(old.stat().st_mode) == 0o640
    assert stat.S_IMODE((tmp_path / "new.csv").stat().st_mode) == 0o640
    assert old.read_text() == "new"


@pytest.mark.skipif(os.name == "nt", reason="POSIX links")
def test_a_link_stays_a_link(old, tmp_path):
    link = tmp_path / "link.csv"
    link.symlink_to(old)
    with replace_file(link, binary=True) as stream:
        stream.write(b"new")
    assert link.is_symlink()
    assert old.read_text() == "new"
    with replace_file(tmp_path / "link.csv") as stream:
        stream.write("newer")
    assert old.read_text() == "newer"


@pytest.mark.skipif(os.name == "nt", reason="POSIX files")
def test_what_is_no_file_is_not_written_to(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "device.csv").symlink_to(os.devnull)
    (tmp_path / "folder.csv").mkdir()
    for name in ("pipe.csv", "device.csv", "folder.csv"):
        assert "not a regular file" in unwritable(tmp_path / name)
        with pytest.raises(OSError, match="not a regular file"), replace_file(tmp_path / name):
            pass
    assert stat.S_ISCHR(os.stat(os.devnull).st_mode)
    assert unwritable(tmp_path / "none" / "a.csv") == f"there is no folder {tmp_path / 'none'}"
    assert unwritable(tmp_path / "a.csv") == ""
    assert "too long" in unwritable(tmp_path / ("a" * 300))


def test_a_folder_or_file_that_may_not_be_written(old, monkeypatch):
    monkeypatch.setattr(files.os, "access", lambda path, _: path != str(old.parent))
    assert "folder" in unwritable(old)
    monkeypatch.setattr(files.os, "access", lambda path, _: path != str(old))
    assert "protected" in unwritable(old)
    with pytest.raises(OSError, match="protected"), replace_file(old):
        pass


def test_two_outputs_that_are_one_file_are_refused(old, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    other = tmp_path / "other.csv"
    distinct({"--out": old, "--history": other, "--figure": None})
    same = [str(old), "./result.csv", "result.csv"]
    if os.name != "nt":
        (tmp_path / "link.csv").symlink_to(old)
        (tmp_path / "ahead.csv").symlink_to(tmp_path / "not-yet.csv")
        same.append("link.csv")
        with pytest.raises(ValueError, match="--history"):
            distinct({"--out": "not-yet.csv", "--history": "ahead.csv"})
    for spelling in same:
        with pytest.raises(ValueError, match=r"--out.*--history.*the same file"):
            distinct({"--out": old, "--history": spelling})


def test_the_content_of_a_file_or_why_it_cannot_be_read(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "LARGEST", 3_000_000)
    path = tmp_path / "a.toml"
    path.write_bytes(b"x" * 3_000_000)

    def read(path):
        return content(path, kind="a scene", remedy="write one")

    def refusal(path):
        with pytest.raises(ValueError, match=" ") as caught:
            read(path)
        return str(caught.value)

    assert len(read(path)) == 3_000_000
    path.write_bytes(b"x" * 3_000_001)
    assert refusal(path) == f"{path}: is too large: 3 MB, a scene has at most 3"
    assert refusal(tmp_path) == f"{tmp_path}: cannot be read: is not a regular file"
    missing, long = tmp_path / "none.toml", tmp_path / ("a" * 300)
    assert refusal(missing) == f"{missing}: no such file; write one"
    assert refusal(long) == f"{long}: cannot be read: {os.strerror(errno.ENAMETOOLONG)}"


def test_an_error_of_another_file_keeps_its_name(old):
    """An error without a number, or about another file, is not about this one."""
    for error in (OSError("odd"), OSError(errno.ENOENT, "none", "other.csv")):
        with pytest.raises(OSError, match=r"odd|other\.csv") as caught, replace_file(old):
            raise error
        assert caught.value is error
        assert str(old) not in str(error)
    assert names(old.parent) == ["result.csv"]


def test_a_table_is_written_with_its_headings(tmp_path):
    write_table(tmp_path / "a.csv", ["a", "b (m)"], [(1.5, "x,y"), (2, "é")])
    assert (tmp_path / "a.csv").read_bytes() == 'a,b (m)\r\n1.5,"x,y"\r\n2,é\r\n'.encode()
    with pytest.raises(OSError, match=" ") as caught, replace_file(tmp_path / "none" / "a.csv"):
        pass
    folder = tmp_path / "none"
    assert str(caught.value) == f"{folder / 'a.csv'}: there is no folder {folder}"


def test_outputs_that_are_the_same_file_are_told_by_their_names(tmp_path):
    path = tmp_path / "a.csv"
    with pytest.raises(ValueError, match=" ") as caught:
        distinct({"--out": path, "--none": None, "--figure": str(path)})
    assert str(caught.value) == f"--out, --figure: {path} is the same file; give two"
