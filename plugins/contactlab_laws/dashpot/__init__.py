"""Normal laws with a dashpot whose restitution does not depend on the speed: linear, Tsuji's."""
