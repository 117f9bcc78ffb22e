"""Wires in pieces, each with one driver."""

from cardcage.testbenches.engines.domains.single_drivers import with_single_drivers

TEXT = r"""module \group
  wire width 2 input 1 \in
  wire width 8 output 2 \out
  attribute \init 8'10100101
  wire width 8 \shared
  attribute \init 5
  wire width 40 \counter
  wire width 4 \whole
  wire width 8 $other
  cell $dff $1
    connect \D \in
    connect \Q \shared [5:4]
  end
  cell $and $2
    connect \A { \shared [6:3] 1'0 \whole }
    connect \Y { \whole \shared [3:0] }
  end
  cell $not $3
    connect \A \shared
    connect \Y \shared [7:6]
  end
  cell \memory_8x4 $4
    connect \read_address \shared [4]
    connect \read_data { \counter [39] \counter [37:0] }
  end
  cell $pos $5
    connect \A \shared
    connect \Y \out
  end
  connect { $other [7] $other [3:0] } { \in [0] \whole }
end
"""

PIECES = r"""module \group
  wire width 2 input 1 \in
  wire width 8 output 2 \out
  attribute \init 4'0101
  wire width 4 \shared_from_0
  attribute \init 2'10
  wire width 2 \shared_from_4
  attribute \init 2'10
  wire width 2 \shared_from_6
  attribute \init 38'xxxxxx00000000000000000000000000000101
  wire width 38 \counter_from_0
  attribute \init 1'x
  wire width 1 \counter_from_38
  attribute \init 1'x
  wire width 1 \counter_from_39
  wire width 4 \whole
  wire width 8 $other
  cell $dff $1
    connect \D \in
    connect \Q \shared_from_4
  end
  cell $and $2
    connect \A { \shared_from_6 [0] \shared_from_4 \shared_from_0 [3] 1'0 \whole }
    connect \Y { \whole \shared_from_0 }
  end
  cell $not $3
    connect \A { \shared_from_6 \shared_from_4 \shared_from_0 }
    connect \Y \shared_from_6
  end
  cell \memory_8x4 $4
    connect \read_address \shared_from_4 [0]
    connect \read_data { \counter_from_39 \counter_from_0 }
  end
  cell $pos $5
    connect \A { \shared_from_6 \shared_from_4 \shared_from_0 }
    connect \Y \out
  end
end
"""


def test_wires_are_cut_where_their_drivers_meet():
    """With what registers begin with; what has one driver stays, other names of a net do not."""
    assert with_single_drivers(TEXT) == PIECES


def test_pieces_have_one_driver_already():
    assert with_single_drivers(PIECES) == PIECES
