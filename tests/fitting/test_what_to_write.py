"""What does not run is refused with what to type, and what is told runs."""

import re
import shlex

from contactlab.cli.main import main
from tests.cli.test_what_to_write import told


def test_headings_in_other_words_are_told_with_a_command_that_runs(tmp_path, capsys):
    table, bodies = tmp_path / "mine.csv", tmp_path / "bodies.toml"
    rows = "10,3.9,6.7,a\n20,3.9,12.2,b\n30,3.9,21.8,c\n39,3.9,32.6,d\n50,3.9,45,e\n"
    table.write_text(f"angle (deg),v_in,angle_out,note\n{rows}", encoding="utf-8")
    bodies.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\nmaterial = 'steel'\n"
        "kind = 'half-space'\n", encoding="utf-8"
    )  # fmt: skip
    told_so = told(capsys, "fit", table, bodies, "--bootstrap", 0)
    first, *_ = re.findall(r"^    contactlab (.*)$", told_so, flags=re.MULTILINE)
    command = shlex.split(first)
    assert command[:5] == ["fit", str(table), str(bodies), "--bootstrap", "0"]
    assert command[5:] == [
        "--column",
        "v_in=speed (m/s)",
        "--column",
        "angle_out=rebound_angle_deg",
    ]
    assert main(command) == 0
    assert "note: left out, for nothing here has such names: note" in capsys.readouterr().out
