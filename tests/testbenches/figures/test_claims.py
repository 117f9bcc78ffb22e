"""Claims on scenes whose numbers are chosen so that they come out, or do not."""

from dataclasses import replace

from cardcage.testbenches.figures import claims
from cardcage.testbenches.figures.claims import claims_of, summary
from cardcage.testbenches.figures.scene_traffic import (
    CONTIGUOUS,
    ROUND_ROBIN,
    SHUFFLED,
    Curve,
    SceneTraffic,
)

GROWING = [100, 130, 145, 150, 153, 154, 155]
FLAT = [100] * 7


def scene(depth=2, sent=GROWING, shuffled=GROWING, contiguous=FLAT, **changes):
    """100 of 200 pixels drawn, each ``depth`` times."""
    curves = [Curve(name, values, [1.0] * 7, values, values) for name, values in (
        (ROUND_ROBIN, sent), (CONTIGUOUS, contiguous), (SHUFFLED, shuffled))]
    counts = [100, *[0] * (depth - 1), 100]
    return replace(SceneTraffic("any", "any", "", None, 200, 50, 40, 100 * depth, counts, curves),
                   **changes)


def outcomes(found):
    return {verdict.claim: verdict.came_out for verdict in claims_of(found)}


def test_as_in_the_paper():
    assert outcomes(scene()) == {claims.CLOSE: True, claims.LESS_DRAMATIC: True,
                                 claims.PLATEAU: True, claims.FLAT_EXPECTED: True}
    close = claims_of(scene())[0]
    assert close.numbers == ("observed is 1.55, equation 4 says 1.50, and pixel by pixel equation "
                             "3 1.50")
    assert str(close).startswith("Expected traffic is close to observed traffic.  Came out: obs")


def test_otherwise():
    assert not outcomes(scene(sent=[100] * 6 + [181]))[claims.CLOSE]
    assert not outcomes(scene(sent=[100] * 7))[claims.CLOSE]
    assert not outcomes(scene(sent=[100] * 7))[claims.PLATEAU]
    assert not outcomes(scene(sent=[100, 120, 130, 140, 150, 160, 170]))[claims.PLATEAU]
    assert not outcomes(scene(sent=[100, 150, 150, 151, 151, 151, 151]))[claims.FLAT_EXPECTED]
    assert not outcomes(scene(sent=[100, 105, 99, 98, 97, 96, 95]))[claims.LESS_DRAMATIC]


def test_reductions():
    assert outcomes(scene(depth=4))[claims.EFFECTIVE]
    assert not outcomes(scene(depth=4, sent=[100, 120, *[201] * 5]))[claims.EFFECTIVE]
    # Wash.ht, by 2.0; Bike, whose depth is less than three, whatever is drawn of the screen.
    assert outcomes(scene(depth=4, row="Wash.ht", sent=[200] * 7))[claims.REDUCED]
    assert outcomes(scene(depth=4, row="Wash.ht", sent=[170] * 7))[claims.REDUCED]
    assert not outcomes(scene(depth=4, row="Wash.ht", sent=[160] * 7))[claims.REDUCED]
    assert not outcomes(scene(depth=4, row="Bike", sent=[100] * 7))[claims.LESS_DRAMATIC]


def test_background():
    assert outcomes(scene(background="first")) == {
        claims.PATHOLOGIC: True, claims.RANDOMISED: False, claims.PLATEAU: True,
        claims.FLAT_EXPECTED: True}
    assert not outcomes(scene(background="first", sent=FLAT))[claims.PATHOLOGIC]
    assert outcomes(scene(background="first", shuffled=FLAT))[claims.RANDOMISED]
    assert outcomes(scene(background="last")) == {claims.LATER: True}
    assert outcomes(scene(background="last", contiguous=GROWING)) == {claims.LATER: False}


def test_summary():
    found = {each.claim: each for each in summary(
        [scene(), scene(name="other", sent=[100] * 7), scene(background="last")])}
    close = found[claims.CLOSE]
    assert str(close) == (f"{claims.CLOSE}  In part: on 1 of 2 scenes; not on other.")
    assert found[claims.LATER].came_out and found[claims.LATER].outcome == "Came out"
    assert found[claims.LESS_DRAMATIC].numbers == "on 1 of 2 scenes; not on other"
    [later] = summary([scene(background="last", contiguous=GROWING)])
    assert later.outcome == "Did not" and not later.came_out
