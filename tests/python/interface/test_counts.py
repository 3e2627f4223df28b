"""Counts in warnings say little of their own, so that frames in a row repeat one text."""
from echopath.base.counts import at_least


def test_a_count_is_said_in_few_ways_none_of_which_says_too_much():
    said = {count: int(at_least(count).removeprefix("at least ").replace(",", "")) for count in range(1, 5001)}
    assert all(count / 2.5 < least <= count for count, least in said.items())
    assert len(set(said.values())) == 12  # 1, 2, 5 to 1000, 2000, 5000
    assert at_least(40) == "at least 20" and at_least(123_456) == "at least 100,000"
