"""A picture that takes longer than a scan: the old one is repeated whole, never torn."""

from frames import check_scans


def test_a_late_picture_repeats_the_old_one_whole():
    repeated = check_scans()
    assert repeated[1] >= 3, "the slow picture is slow"
