"""The table's rules, on numbers made up for each."""

import unittest

import table


def cell(program, triangles=100, image=1.0, **more):
    errors = {key: 1.0 for key, _, _ in table.MEASURES if key != "cpu_s"} | {"image_rmse": image}
    facts = {"model": "m", "ratio": 0.1, "count": 100, "program": program, "ours": program.startswith("Outsight")}
    return facts | errors | {"triangles": triangles, "seconds": [2.0, 1.0]} | more


class Table(unittest.TestCase):
    def test_who_stops_above_the_count_is_marked_and_never_the_best(self):
        early = cell("early", triangles=102, image=0.1)
        on_count = cell("on count", triangles=101, image=0.5)
        self.assertIs(table.best([early, on_count], "image_rmse"), on_count)
        self.assertIn("| early | 102 ↑ | 0.10 |", table.rows([early, on_count]))
        self.assertIn("| on count | 101 | **0.50** |", table.rows([early, on_count]))

    def test_who_goes_far_below_the_count_is_marked_and_never_the_best(self):
        less, on_count = cell("less", triangles=89, image=0.1), cell("on count", triangles=90, image=0.5)
        self.assertIs(table.best([less, on_count], "image_rmse"), on_count)
        self.assertIn("| less | 89 ↓ | 0.10 |", table.rows([less, on_count]))

    def test_the_least_of_the_repeats_counts(self):
        self.assertEqual(table.value(cell("a"), "cpu_s"), 1.0)

    def test_a_failure_is_shown_and_is_not_compared(self):
        failed = {"model": "m", "ratio": 0.1, "count": 100, "program": "a", "ours": False, "failed": "out | of memory"}
        self.assertIsNone(table.best([failed], "image_rmse"))
        row = table.rows([failed]).splitlines()[-1]
        self.assertIn("failed: out / of memory", row)
        self.assertEqual(row.count(" |"), table.rows([failed]).splitlines()[0].count(" |"))

    def test_less_error_is_against_the_best_rival_of_the_same_count(self):
        cells = [cell("Outsight VG", image=3.0), cell("Outsight QB", image=1.0), cell("a", image=4.0), cell("b", image=5.0)]
        cells += [cell("Outsight VG", image=2.0, ratio=0.2), cell("a", image=1.0, ratio=0.2)]
        lines = table.summary(cells).splitlines()[2:]
        self.assertEqual(len(lines), 2)
        self.assertIn("| a | 4.00 | 3.00 | +25.0 % |", lines[0])
        self.assertIn("| a | 1.00 | 2.00 | -100.0 % |", lines[1])

    def test_the_second_judge_reports_its_largest_difference(self):
        cells = [cell("a", image=1.0, second_image_rmse=1.0), cell("b", image=1.01, second_image_rmse=1.0), cell("c")]
        self.assertIn("2 cells", table.second_judge(cells))
        self.assertIn("1.0000 % at most (m, b, 100 triangles)", table.second_judge(cells))


if __name__ == "__main__":
    unittest.main()
