"""What stands beside roads: poles, signs, guard rails, trees."""
