"""``contactlab kernel`` writes what the package holds, whole."""

from importlib import resources

from contactlab.cli.kernel import FILES


def test_the_files_are_those_of_the_package(run, tmp_path):
    ran = run("kernel", "--out", tmp_path / "deep" / "kernel")
    assert ran.status == 0
    kernels = resources.files("contactlab").joinpath("kernels")
    assert sorted(each.name for each in kernels.iterdir()) == sorted(FILES)
    for name in FILES:
        file = tmp_path / "deep" / "kernel" / name
        assert file.read_text("utf-8") == kernels.joinpath(name).read_text("utf-8")
        assert str(file) in ran.out


def test_a_file_is_no_folder(run, tmp_path):
    (tmp_path / "kernel").write_text("mine")
    refused = run("kernel", "--out", tmp_path / "kernel")
    assert refused.status == 2
    assert "is a file; give a folder" in refused.err
    assert (tmp_path / "kernel").read_text() == "mine"


def test_a_folder_must_be_named(run):
    ran = run("kernel")
    assert ran.status == 2
    assert "--out" in ran.err
