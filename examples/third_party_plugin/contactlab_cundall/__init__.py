"""The linear spring and slider of Cundall & Strack, for contactlab."""
