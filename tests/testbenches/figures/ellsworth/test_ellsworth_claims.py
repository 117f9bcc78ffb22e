"""Claims on models whose numbers are chosen so that they come out, or do not."""

from dataclasses import replace
from itertools import product

from cardcage.testbenches.figures.ellsworth import claims
from cardcage.testbenches.figures.ellsworth.claims import claims_of, claims_of_overlap, summary
from cardcage.testbenches.figures.ellsworth.dealing.cures import CURES, LAST
from cardcage.testbenches.figures.ellsworth.dealing.dealing_job import HOW
from cardcage.testbenches.figures.ellsworth.dealing.model_dealing import ModelDealing
from cardcage.testbenches.figures.ellsworth.dealing.models import FigureModel
from cardcage.testbenches.figures.ellsworth.dealing.screen_grids import RATIOS
from cardcage.testbenches.figures.ellsworth.findings import best_cure, findings
from cardcage.testbenches.figures.ellsworth.overlap import Overlap

PROCESSORS = (2, 32, 512)


def as_expected(processors, ratio, how):
    """Rises with the ratio, falls with the processors."""
    even = min(1.0, ratio ** 0.35 / processors ** 0.1)
    return {"static": 0.5 * even, "static, scattered": 0.7 * even, "ceiling": 1.0}.get(
        how, even - (0.07 if processors == 512 and "last" in how else 0.0))


def model(utilisation=as_expected, overlap=1.2, cures=None, **changes):
    regions = sorted({each * ratio for each, ratio in product((*PROCESSORS, 64), RATIOS)} | {256})
    return ModelDealing(replace(FigureModel("any", "any", 1, 4.5), **changes), (9, 9), {
        "given": [1000], "drawn": [1000], "fragments": [4000], "width": [3], "height": [3],
        "visits": {str(each): [1000 * overlap + each / 10] for each in regions},
        "clocks": {str(each): [4000] for each in regions},
        "utilisation": {str(each): {str(ratio): {how: [utilisation(each, ratio, how)]
                                                 for how in HOW} for ratio in RATIOS}
                        for each in PROCESSORS},
        "cures": {} if cures is None else {"64": {cure.name: [cures.get(cure.name, 0.5)]
                                                  for cure in CURES}}})


def outcomes(found):
    return {verdict.claim: verdict.came_out for verdict in claims_of(found)}


def test_as_in_the_paper():
    found = outcomes(model())
    assert found.pop(claims.EIGHT) is False  # a steep curve: 12 is far better
    assert found == dict.fromkeys((
        claims.RISES, claims.FALLS, claims.DROPS, claims.LARGER, claims.UNBALANCED, claims.OVERLAPS,
        claims.SENDS), True)
    numbers = {verdict.claim: verdict.numbers for verdict in claims_of(model())}
    assert numbers[claims.DROPS].startswith("by triangles at most 7 points on 512 processors")
    assert numbers[claims.LARGER] == (
        "for a utilisation of 0.75 1 on 2, 2 on 32, 4 on 512")


def test_otherwise():
    assert not outcomes(model(lambda n, ratio, how: 1 / ratio))[claims.RISES]
    assert not outcomes(model(lambda n, ratio, how: n / 512))[claims.FALLS]
    assert not outcomes(model(lambda n, ratio, how: 0.9 - 0.2 * ("last" in how)))[claims.DROPS]
    assert not outcomes(model(lambda n, ratio, how: 0.8))[claims.LARGER]
    assert not outcomes(model(lambda n, ratio, how: 0.9 if how == "static" else 0.5))[
        claims.UNBALANCED]
    assert not outcomes(model(overlap=1.5))[claims.OVERLAPS]


def test_the_ratio_that_is_best():
    even = model(lambda n, ratio, how: 0.9, best_ratio=2)
    assert outcomes(even)[claims.BEST]  # more regions only overlap more
    assert not outcomes(model(lambda n, ratio, how: 0.9, best_ratio=12))[claims.BEST]
    assert claims.BEST not in outcomes(model())
    assert not outcomes(even)[claims.SENDS]  # it is the least whatever sending costs
    assert outcomes(model(lambda n, ratio, how: 0.9 if ratio == 8 else 0.5))[claims.EIGHT]
    assert not outcomes(model(lambda n, ratio, how: 0.9 if ratio != 8 else 0.5))[claims.EIGHT]


def overlap(columns, rows, measured):
    return Overlap(16, columns, rows, False, (8.0, 8.0), (8.0, 8.0),
                   (640 / columns, 512 / rows), measured)


def test_shapes():
    [square] = claims_of_overlap([overlap(64, 4, 1.7), overlap(16, 16, 1.4), overlap(4, 64, 1.9)])
    assert square.came_out and "1.40 on 16×16" in square.numbers
    [other] = claims_of_overlap([overlap(64, 4, 1.3), overlap(16, 16, 1.4)])
    assert not other.came_out
    assert claims_of_overlap([]) == []
    assert {each.claim for each in summary([model()], [overlap(16, 16, 1)])} >= {
        claims.SQUARE, claims.RISES}


def test_findings():
    models = [model(cures={LAST: 0.6, "growth learnt": 0.7, "coming boxes' pixels": 0.8})]
    assert best_cure(models).name == "coming boxes' pixels"
    assert best_cure(models, "counters").name == "growth learnt"
    lines = findings(models)
    assert lines[1] == ("Best cure for the last frame's loss: coming boxes' pixels, +20.0 points "
                        "on average (any on 64 from 0.600 to 0.800).")
    assert lines[2].startswith("Best of those that need no more hardware than counters: growth l")
    assert len(findings([model()])) == 1
    bound = model(lambda n, ratio, how: min(0.9, 20 / n))
    assert findings([bound])[-1].startswith(
        "any: from 2 processors on one region alone holds more than an even share in some frames; "
        "on 512 no table exceeds 0.04")
