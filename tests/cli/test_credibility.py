# SPDX-License-Identifier: GPL-3.0-or-later
"""The credibility page: six topics, every figure computed now and given again by the command beside it, nothing hidden."""
import json
import pathlib
import unittest

from support import cli_json, folder_of_class

TOPICS = ["Context of use", "Code verification", "Calculation verification", "Validation", "Uncertainty", "Applicability"]


class Credibility(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of_class(cls) / "credibility"
        cls.said = cli_json("validate", "--credibility", "--quick", "--output", cls.folder)
        cls.lines = cls.said["lines"]

    def line(self, words):
        found = [one for one in self.lines if words in one["what"]]
        self.assertEqual(len(found), 1, words)
        return found[0]

    def test_every_topic_in_order(self):
        topics = [one["topic"] for one in self.lines]
        self.assertEqual(list(dict.fromkeys(topics)), TOPICS)
        self.assertEqual(topics, sorted(topics, key=TOPICS.index))

    def test_a_line_has_a_figure_and_its_command_or_a_reason(self):
        for one in self.lines:
            with self.subTest(what=one["what"]):
                self.assertIn(one["state"], {"met", "missed", "shown", "stated", "not run"})
                if one["state"] in ("met", "missed", "shown"):
                    self.assertTrue(one["command"].startswith("glisson-cli "))
                    self.assertTrue(one["figures"] or one["why"])
                if one["state"] == "not run":
                    self.assertTrue(one["why"])
                    self.assertEqual(one["figures"], [])
                if one["state"] == "stated":
                    self.assertTrue(one["found"])

    def test_what_quick_leaves_out_is_said(self):
        self.assertTrue(self.said["quick"])
        self.assertIn("--quick", [one for one in self.lines if one["topic"] == "Uncertainty"][0]["why"])

    def test_no_part_ended_in_an_error(self):
        self.assertEqual([one["why"] for one in self.lines if (one["why"] or "").startswith("ended with")], [])

    def test_manufactured_solutions_converge_as_they_must(self):
        for words in ("varying", "finite strain"):
            line = self.line(words)
            self.assertEqual(line["state"], "met", line)
            self.assertLess(abs(line["figures"][0]["value"] - 2.0), 0.4)

    def test_the_command_beside_a_figure_gives_it_again(self):
        rows = cli_json("validate", "contact", "--quick")["rows"]
        lines = [one for one in self.lines if one["command"] == "glisson-cli validate contact --quick"]
        self.assertEqual(len(lines), len({row["reference"] for row in rows}))
        for one in lines:
            errors = [row["max_error_mm"] for row in rows if row["reference"] in one["what"] and row["max_error_mm"] is not None]
            self.assertAlmostEqual(one["figures"][0]["value"], min(errors), delta=1e-9 * min(errors))

    def test_the_page_and_the_record_say_the_same(self):
        record = json.loads((self.folder / "credibility.json").read_text())
        self.assertEqual(record["lines"], self.lines)
        page = (self.folder / "credibility.html").read_text()
        for one in self.lines:
            self.assertEqual(page.count("<td>" + one["state"] + "</td>") > 0, True)
        for topic in TOPICS:
            self.assertIn(topic, page)
        self.assertTrue((self.folder / "credibility.pdf").read_bytes().startswith(b"%PDF"))
        self.assertEqual(sorted(pathlib.Path(f).name for f in self.said["files"]),
                         ["credibility.html", "credibility.json", "credibility.pdf"])


if __name__ == "__main__":
    unittest.main()
