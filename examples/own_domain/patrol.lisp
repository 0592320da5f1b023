; A round through the restaurant: the robot folds its arms and drives to two areas, one after the other.
; Only (RobotAt area) is needed of the state.

(defdomain patrol (

(:operator (!tuck_arms ?left_goal ?right_goal)
  ()
  ()
  ())

(:operator (!move_base ?area)
  ((RobotAt ?from))
  ((RobotAt ?from))
  ((RobotAt ?area)))

; Subtasks in order run in order.
(:method (patrol ?first ?second)
  ()
  ((!tuck_arms armtuckedposture armtuckedposture) (!move_base ?first) (!move_base ?second)))

))
