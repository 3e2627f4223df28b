"""Warnings of commands: a line for each, however often and with whatever numbers it comes."""
import warnings

from echopath.cli.warned import warnings_in_lines


def test_texts_that_differ_in_numbers_alone_are_one_line_and_a_count(capsys):
    with warnings_in_lines():
        warnings.simplefilter("always")
        for text in ("12 paths of 'car_1' are lost, 1.5e-3 dB", "7 paths of 'car_1' are lost, 2 dB",
                     "7 paths of 'car_1' are lost, 2 dB", "1,024 paths of 'car_2' are lost, 2 dB", "1,024 paths are lost"):
            warnings.warn(text, RuntimeWarning, stacklevel=1)
    assert capsys.readouterr().err.splitlines() == [
        "warning: 12 paths of 'car_1' are lost, 1.5e-3 dB", "warning: 1,024 paths of 'car_2' are lost, 2 dB",
        "warning: 1,024 paths are lost",
        "warning: 1 more warning with other numbers, of: 12 paths of 'car_1' are lost, 1.5e-3 dB"]


def test_what_was_warned_of_before_an_error_is_told(capsys):
    try:
        with warnings_in_lines():
            warnings.simplefilter("always")
            for count in (1, 2, 3):
                warnings.warn(f"{count} of them", RuntimeWarning, stacklevel=1)
            raise ValueError
    except ValueError:
        pass
    assert capsys.readouterr().err == "warning: 1 of them\nwarning: 2 more warnings with other numbers, of: 1 of them\n"
